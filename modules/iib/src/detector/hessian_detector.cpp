// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/file_numbers.hpp"
#include "../common/image_input.hpp"
#include "../normalization/local_normalization.hpp"
#include "blobs.hpp"

#include "opencv2/core/utils/trace.hpp"
#include "opencv2/iib/detail/files.hpp"
#include "opencv2/iib/hessian_detector.hpp"

#include <numeric>

namespace cv { namespace iib {

namespace {

//! Rounded means of `factor` x `factor` pixels; incomplete squares at the right and bottom are dropped.
template <typename T> Mat reduced(const Mat& grey, int factor)
{
    Mat result(grey.rows / factor, grey.cols / factor, grey.type());
    parallel_for_(Range(0, result.rows), [&](const Range& range) {
        const int width = grey.cols;  // a copy, so that compilers vectorize the loop
        std::vector<unsigned> sums(width);
        for (int y = range.start; y < range.end; y++)
        {
            std::fill(sums.begin(), sums.end(), 0u);
            for (int i = 0; i < factor; i++)
            {
                const T* const row = grey.ptr<T>(factor * y + i);
                for (int x = 0; x < width; x++)
                    sums[x] += row[x];
            }
            T* const out = result.ptr<T>(y);
            const uint64 area = (uint64)factor * factor;
            for (int x = 0; x < result.cols; x++)
                out[x] = (T)((std::accumulate(&sums[factor * x], &sums[factor * x] + factor, area / 2)) /
                             area);
        }
    });
    return result;
}

//! By how much images are reduced. Long and narrow ones keep a quarter of the working size across.
int reductionOf(Size image, int workingSize)
{
    const int64 longer = std::max(image.width, image.height), shorter = std::min(image.width, image.height);
    return (int)std::min(
            (longer + workingSize - 1) / workingSize, std::max(4 * shorter / workingSize, (int64)1));
}

class HessianDetector_Impl CV_FINAL : public HessianDetector, public AnyImage
{
public:
    explicit HessianDetector_Impl(const HessianParameters& parameters) : p(parameters) { p.check(); }

    void detectAndCompute(InputArray imageArray, InputArray maskArray, std::vector<KeyPoint>& keypoints,
            OutputArray descriptors, bool useProvidedKeypoints) CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();

        if (descriptors.needed() || useProvidedKeypoints)
            CV_Error(Error::StsNotImplemented,
                    "HessianDetector finds keypoints but does not describe them; describe them with "
                    "IIBDescriptorExtractor::createFor(detector)");
        const Mat image = imageArray.getMat();
        if (image.empty())
            return keypoints.clear();
        checkImage(image);
        const Mat mask = maskFor(maskArray, image.size());
        Mat grey = integerMap(image);
        const int reduction = p.workingSize ? reductionOf(grey.size(), p.workingSize) : 1;
        if (reduction > 1)
            grey = grey.depth() == CV_8U ? reduced<uchar>(grey, reduction) : reduced<ushort>(grey, reduction);
        keypoints = findBlobs(normalizeLocally(grey, p.normalizationSigma), p, mask, reduction);
    }

    bool empty() const CV_OVERRIDE { return false; }

    void setMaxFeatures(int value) CV_OVERRIDE { set(&HessianParameters::maxFeatures, value); }
    int getMaxFeatures() const CV_OVERRIDE { return p.maxFeatures; }
    void setThreshold(float value) CV_OVERRIDE { set(&HessianParameters::threshold, value); }
    float getThreshold() const CV_OVERRIDE { return p.threshold; }
    void setScales(int value) CV_OVERRIDE { set(&HessianParameters::scales, value); }
    int getScales() const CV_OVERRIDE { return p.scales; }
    void setSigma(float value) CV_OVERRIDE { set(&HessianParameters::sigma, value); }
    float getSigma() const CV_OVERRIDE { return p.sigma; }
    void setNormalizationSigma(float value) CV_OVERRIDE
    {
        set(&HessianParameters::normalizationSigma, value);
    }
    float getNormalizationSigma() const CV_OVERRIDE { return p.normalizationSigma; }
    void setWorkingSize(int value) CV_OVERRIDE { set(&HessianParameters::workingSize, value); }
    int getWorkingSize() const CV_OVERRIDE { return p.workingSize; }

    String getDefaultName() const CV_OVERRIDE { return Feature2D::getDefaultName() + ".HessianDetector"; }

    using Feature2D::write;
    void write(FileStorage& fs) const CV_OVERRIDE
    {
        // one node, so that Algorithm::load() reads files of Feature2D::write(filename)
        fs << "HessianDetector"
           << "{"
           << "format" << 1 << "maxFeatures" << p.maxFeatures << "threshold" << p.threshold << "scales"
           << p.scales << "sigma" << p.sigma << "normalizationSigma" << p.normalizationSigma << "workingSize"
           << p.workingSize << "}";
    }

    using Feature2D::read;
    void read(const FileNode& node) CV_OVERRIDE
    {
        const FileNode fn = nodeOfFormat1(node, "HessianDetector");
        HessianParameters r = p;
        readNumber(fn, "maxFeatures", r.maxFeatures);
        readNumber(fn, "threshold", r.threshold);
        readNumber(fn, "scales", r.scales);
        readNumber(fn, "sigma", r.sigma);
        readNumber(fn, "normalizationSigma", r.normalizationSigma);
        readNumber(fn, "workingSize", r.workingSize);
        r.check();
        p = r;
    }

    void save(const String& filename) const CV_OVERRIDE { saveWhole(*this, filename); }

private:
    template <typename T> void set(T HessianParameters::*member, T value)
    {
        HessianParameters changed = p;
        changed.*member = value;
        changed.check();
        p = changed;
    }

    HessianParameters p;
};

}  // namespace

Ptr<HessianDetector> HessianDetector::create(
        int maxFeatures, float threshold, int scales, float sigma, float normalizationSigma, int workingSize)
{
    const HessianParameters p = {maxFeatures, threshold, scales, sigma, normalizationSigma, workingSize};
    return makePtr<HessianDetector_Impl>(p);
}

}}  // namespace cv::iib
