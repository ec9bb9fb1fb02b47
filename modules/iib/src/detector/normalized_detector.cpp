// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/detector_file.hpp"
#include "../common/file_numbers.hpp"
#include "../common/image_input.hpp"
#include "../normalization/local_normalization.hpp"

#include "opencv2/core/utils/trace.hpp"
#include "opencv2/iib/detail/files.hpp"
#include "opencv2/iib/normalized_detector.hpp"

namespace cv { namespace iib {

namespace {

void checkSigma(float sigma) { require(sigma >= 1 && sigma <= 256, "sigma", sigma, "1 to 256 pixels"); }

class NormalizedDetector_Impl CV_FINAL : public NormalizedDetector, public AnyImage
{
public:
    NormalizedDetector_Impl(const Ptr<Feature2D>& detector_, float sigma_)
        : detector(detector_), sigma(sigma_)
    {
        if (!detector)
            CV_Error(Error::StsNullPtr, "the detector is null");
        checkSigma(sigma);
    }

    void detectAndCompute(InputArray imageArray, InputArray mask, std::vector<KeyPoint>& keypoints,
            OutputArray descriptors, bool useProvidedKeypoints) CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();

        const Mat image = imageArray.getMat();
        if (!useProvidedKeypoints)
            keypoints.clear();
        if (!useProvidedKeypoints && !image.empty())
        {
            checkImage(image);
            const Mat grey = integerMap(image);
            detector->detect(normalizeLocally(grey, sigma), keypoints, maskFor(mask, image.size()));
        }
        if (!descriptors.needed())
            return;
        if (detector->descriptorSize() == 0)
            CV_Error(Error::StsNotImplemented,
                    detector->getDefaultName() +
                            " finds keypoints but does not describe them; describe them with "
                            "another Feature2D, such as IIBDescriptorExtractor::createFor");
        detector->compute(imageFor(*detector, image), keypoints, descriptors);
    }

    int descriptorSize() const CV_OVERRIDE { return detector->descriptorSize(); }
    int descriptorType() const CV_OVERRIDE { return detector->descriptorType(); }
    int defaultNorm() const CV_OVERRIDE { return detector->defaultNorm(); }
    bool empty() const CV_OVERRIDE { return false; }

    Ptr<Feature2D> getDetector() const CV_OVERRIDE { return detector; }
    void setSigma(float value) CV_OVERRIDE
    {
        checkSigma(value);
        sigma = value;
    }
    float getSigma() const CV_OVERRIDE { return sigma; }

    String getDefaultName() const CV_OVERRIDE { return Feature2D::getDefaultName() + ".NormalizedDetector"; }

    using Feature2D::write;
    void write(FileStorage& fs) const CV_OVERRIDE
    {
        // one node, as HessianDetector's
        fs << "NormalizedDetector"
           << "{"
           << "format" << 1;
        writeDetector(fs, *this);
        fs << "}";
    }

    using Feature2D::read;
    void read(const FileNode& node) CV_OVERRIDE
    {
        const FileNode fn = nodeOfFormat1(node, "NormalizedDetector");
        const Ptr<NormalizedDetector> other = readDetector(fn, detector).dynamicCast<NormalizedDetector>();
        if (!other)
            CV_Error(Error::StsParseError, "the node holds no NormalizedDetector but another class");
        detector = other->getDetector();
        sigma = other->getSigma();
    }

    void save(const String& filename) const CV_OVERRIDE { saveWhole(*this, filename); }

private:
    Ptr<Feature2D> detector;
    float sigma;
};

}  // namespace

Ptr<NormalizedDetector> NormalizedDetector::create(const Ptr<Feature2D>& detector, float sigma)
{
    return makePtr<NormalizedDetector_Impl>(detector, sigma);
}

}}  // namespace cv::iib
