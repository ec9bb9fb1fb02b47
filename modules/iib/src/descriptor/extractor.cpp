// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "compute.hpp"
#include "input.hpp"
#include "layout.hpp"
#include "support_region.hpp"

#include <numeric>

#include "opencv2/core/utils/trace.hpp"

namespace cv {
namespace iib {

namespace {

class IIBDescriptorExtractor_Impl CV_FINAL : public IIBDescriptorExtractor
{
public:
    explicit IIBDescriptorExtractor_Impl(const Parameters& parameters)
        : p(parameters), detector(ORB::create())
    {
        p.check();
    }

    void compute(InputArray image, std::vector<KeyPoint>& keypoints, OutputArray descriptors) CV_OVERRIDE
    {
        compute(image, noArray(), keypoints, descriptors);
    }

    void compute(InputArray image, InputArrayOfArrays extraChannels, std::vector<KeyPoint>& keypoints,
            OutputArray descriptors) CV_OVERRIDE;

    void detectAndCompute(InputArray image, InputArray mask, std::vector<KeyPoint>& keypoints,
            OutputArray descriptors, bool useProvidedKeypoints) CV_OVERRIDE
    {
        if (!useProvidedKeypoints)
            detector->detect(image, keypoints, mask);
        if (descriptors.needed())
            compute(image, keypoints, descriptors);
    }

    std::vector<int> levelSizes() const CV_OVERRIDE { return levelBytes(p); }
    int descriptorSize() const CV_OVERRIDE
    {
        const std::vector<int> bytes = levelBytes(p);
        return std::accumulate(bytes.begin(), bytes.end(), 0);
    }
    int descriptorType() const CV_OVERRIDE { return CV_8U; }
    int defaultNorm() const CV_OVERRIDE { return NORM_HAMMING; }
    bool empty() const CV_OVERRIDE { return false; }

    void setScaleFactor(float value) CV_OVERRIDE { set(&Parameters::scaleFactor, value); }
    float getScaleFactor() const CV_OVERRIDE { return p.scaleFactor; }
    void setGranularity(int value) CV_OVERRIDE { setShape(&Parameters::granularity, value); }
    int getGranularity() const CV_OVERRIDE { return p.granularity; }
    void setChannels(int value) CV_OVERRIDE { setShape(&Parameters::channels, value); }
    int getChannels() const CV_OVERRIDE { return p.channels; }
    void setMapping(int value) CV_OVERRIDE { setShape(&Parameters::mapping, value); }
    int getMapping() const CV_OVERRIDE { return p.mapping; }
    void setOverlap(bool value) CV_OVERRIDE { setShape(&Parameters::overlap, value); }
    bool getOverlap() const CV_OVERRIDE { return p.overlap; }
    void setUseOrientation(bool value) CV_OVERRIDE { set(&Parameters::useOrientation, value); }
    bool getUseOrientation() const CV_OVERRIDE { return p.useOrientation; }
    void setExtraChannels(int value) CV_OVERRIDE { setShape(&Parameters::extraChannels, value); }
    int getExtraChannels() const CV_OVERRIDE { return p.extraChannels; }
    void setBorder(int value) CV_OVERRIDE { set(&Parameters::border, value); }
    int getBorder() const CV_OVERRIDE { return p.border; }

    void setDetector(const Ptr<Feature2D>& value) CV_OVERRIDE
    {
        if (!value)
            CV_Error(Error::StsNullPtr, "the detector is null");
        detector = value;
    }
    Ptr<Feature2D> getDetector() const CV_OVERRIDE { return detector; }

    void setSelection(InputArray quads) CV_OVERRIDE
    {
        const Mat q = quads.getMat();
        if (!q.empty() && (q.type() != CV_32S || q.dims != 2 || q.cols != 5))
            CV_Error(Error::StsBadArg,
                    "a selection is CV_32S with 5 columns (level, channel, row, column, bits), not " +
                            typeToString(q.type()) + format(" with %d", q.cols));
        Parameters changed = p;
        changed.selection = q.empty() ? Mat_<int>() : Mat_<int>(q.clone());
        replace(changed);
    }
    Mat getSelection() const CV_OVERRIDE { return p.selection.clone(); }

    String getDefaultName() const CV_OVERRIDE { return Feature2D::getDefaultName() + ".IIB"; }
    using Feature2D::write;
    void write(FileStorage& fs) const CV_OVERRIDE;
    using Feature2D::read;
    void read(const FileNode& fn) CV_OVERRIDE;
    void save(const String& filename) const CV_OVERRIDE
    {
        // a node's name may not hold the dot of getDefaultName()
        FileStorage fs(filename, FileStorage::WRITE);
        CV_Assert(fs.isOpened());
        fs << "IIB"
           << "{";
        write(fs);
        fs << "}";
    }

private:
    void replace(const Parameters& changed)
    {
        changed.check();
        p = changed;
    }

    template <typename T> void set(T Parameters::*member, T value)
    {
        Parameters changed = p;
        changed.*member = value;
        replace(changed);
    }

    //! Sets what the selection's rows refer to, which ends it.
    template <typename T> void setShape(T Parameters::*member, T value)
    {
        Parameters changed = p;
        if (changed.*member != value)
            changed.selection.release();
        changed.*member = value;
        replace(changed);
    }

    Parameters p;
    Ptr<Feature2D> detector;
};

void IIBDescriptorExtractor_Impl::compute(InputArray imageArray, InputArrayOfArrays extraArrays,
        std::vector<KeyPoint>& keypoints, OutputArray descriptors)
{
    CV_TRACE_FUNCTION();

    const Mat image = imageArray.getMat();
    std::vector<Mat> extra;
    if (extraArrays.isMat() || extraArrays.isUMat())
        extra.push_back(extraArrays.getMat());  // not its rows
    else if (!extraArrays.empty())
        extraArrays.getMatVector(extra);
    checkKeyPoints(keypoints);
    if (image.empty())
    {
        descriptors.release();
        return;
    }
    checkImage(image);
    checkExtraChannels(extra, p.extraChannels, image.size());

    if (p.border == BORDER_DROP)
    {
        const Parameters& params = p;
        keypoints.erase(std::remove_if(keypoints.begin(), keypoints.end(),
                                [&](const KeyPoint& kp) {
                                    return !SupportRegion(kp, params.scaleFactor, params.granularity)
                                                    .isInside(image.size());
                                }),
                keypoints.end());
    }
    if (keypoints.empty())
    {
        descriptors.release();
        return;
    }

    descriptors.create((int)keypoints.size(), descriptorSize(), CV_8U);
    Mat result = descriptors.getMat();
    describe(p, image, extra, keypoints, result);
}

void IIBDescriptorExtractor_Impl::write(FileStorage& fs) const
{
    fs << "format" << 1 << "scaleFactor" << p.scaleFactor << "granularity" << p.granularity << "channels"
       << p.channels << "mapping" << p.mapping << "overlap" << p.overlap << "useOrientation"
       << p.useOrientation << "extraChannels" << p.extraChannels << "border" << p.border;
    if (!p.selection.empty())
        fs << "selection" << std::vector<int>(p.selection.begin(), p.selection.end());
}

//! A number that is missing keeps its value.
template <typename T> void readNumber(const FileNode& fn, const char* name, T& value)
{
    const FileNode number = fn[name];
    if (!number.empty() && !number.isInt() && !number.isReal())
        CV_Error(Error::StsParseError, format("%s is not a number", name));
    cv::read(number, value, value);
}

void IIBDescriptorExtractor_Impl::read(const FileNode& fn)
{
    int format = 0;
    cv::read(fn["format"], format, 0);
    if (format != 1)
        CV_Error(Error::StsParseError, "the node holds no IIB parameters of format 1");
    Parameters r = p;
    readNumber(fn, "scaleFactor", r.scaleFactor);
    readNumber(fn, "granularity", r.granularity);
    readNumber(fn, "channels", r.channels);
    readNumber(fn, "mapping", r.mapping);
    readNumber(fn, "overlap", r.overlap);
    readNumber(fn, "useOrientation", r.useOrientation);
    readNumber(fn, "extraChannels", r.extraChannels);
    readNumber(fn, "border", r.border);
    std::vector<int> quads;
    fn["selection"] >> quads;
    if (quads.size() % 5 != 0)
        CV_Error(Error::StsParseError, "the selection's length is no multiple of 5 numbers");
    r.selection = quads.empty() ? Mat_<int>() : Mat_<int>(Mat(quads, true).reshape(1, (int)quads.size() / 5));
    replace(r);
}

}  // namespace

Ptr<IIBDescriptorExtractor> IIBDescriptorExtractor::create(float scaleFactor, int granularity, int channels,
        int mapping, bool overlap, bool useOrientation, int extraChannels)
{
    const Parameters p = {scaleFactor, granularity, channels, mapping, overlap, useOrientation, extraChannels,
            BORDER_CLAMP, Mat_<int>()};
    return makePtr<IIBDescriptorExtractor_Impl>(p);
}

}  // namespace iib
}  // namespace cv
