// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/detector_file.hpp"
#include "../common/detector_input.hpp"
#include "../common/file_numbers.hpp"
#include "compute.hpp"
#include "input.hpp"
#include "support_region.hpp"

#include "opencv2/core/utils/trace.hpp"

namespace cv {
namespace iib {

namespace {

class IIBDescriptorExtractor_Impl CV_FINAL : public IIBDescriptorExtractor
{
public:
    explicit IIBDescriptorExtractor_Impl(const Parameters& parameters)
        : p(parameters), plan(planOf(parameters)), detector(ORB::create())
    {
    }

    void compute(InputArray image, std::vector<KeyPoint>& keypoints, OutputArray descriptors) CV_OVERRIDE
    {
        compute(image, noArray(), keypoints, descriptors);
    }

    void compute(InputArray image, InputArrayOfArrays extraChannels, std::vector<KeyPoint>& keypoints,
            OutputArray descriptors) CV_OVERRIDE;

    void detectAndCompute(InputArray imageArray, InputArray mask, std::vector<KeyPoint>& keypoints,
            OutputArray descriptors, bool useProvidedKeypoints) CV_OVERRIDE
    {
        const Mat image = imageArray.getMat();
        if (!useProvidedKeypoints)
            detector->detect(imageFor(*detector, image), keypoints,
                    image.empty() ? Mat() : maskFor(mask, image.size()));
        if (descriptors.needed())
            compute(image, keypoints, descriptors);
    }

    std::vector<int> levelSizes() const CV_OVERRIDE { return plan->levelBytes; }
    int descriptorSize() const CV_OVERRIDE { return plan->bytes; }
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
    void setUseOrientation(bool value) CV_OVERRIDE
    {
        setOrientation(value ? ORIENTATION_KEYPOINT : ORIENTATION_NONE);
    }
    bool getUseOrientation() const CV_OVERRIDE { return p.orientation != ORIENTATION_NONE; }
    void setOrientation(int value) CV_OVERRIDE { set(&Parameters::orientation, value); }
    int getOrientation() const CV_OVERRIDE { return p.orientation; }
    void setExtraChannels(int value) CV_OVERRIDE { setShape(&Parameters::extraChannels, value); }
    int getExtraChannels() const CV_OVERRIDE { return p.extraChannels; }
    void setBorder(int value) CV_OVERRIDE { set(&Parameters::border, value); }
    int getBorder() const CV_OVERRIDE { return p.border; }

    void setDetector(const Ptr<Feature2D>& value) CV_OVERRIDE
    {
        if (!value)
            CV_Error(Error::StsNullPtr, "the detector is null");
        if (leadsBack(value))
            CV_Error(Error::StsBadArg, "the extractor cannot be its own detector; give it one that finds "
                                       "keypoints, such as ORB");
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
        write(fs);
    }

private:
    //! Whether `feature` is this extractor, or a class of this library that holds it.
    bool leadsBack(Ptr<Feature2D> feature) const
    {
        while (feature && feature.get() != this)
        {
            const Ptr<IIBDescriptorExtractor> other = feature.dynamicCast<IIBDescriptorExtractor>();
            const Ptr<NormalizedDetector> wrapper = feature.dynamicCast<NormalizedDetector>();
            feature = other ? other->getDetector() : wrapper ? wrapper->getDetector() : Ptr<Feature2D>();
        }
        return feature.get() == this;
    }

    static Ptr<const DescriptorPlan> planOf(const Parameters& parameters)
    {
        parameters.check();
        return makePtr<const DescriptorPlan>(parameters);
    }

    void replace(const Parameters& changed)
    {
        plan = planOf(changed);
        p = changed;
    }

    template <typename T> void set(T Parameters::*member, T value)
    {
        Parameters changed = p;
        changed.*member = value;
        replace(changed);
    }

    //! Sets a parameter that the rows of a selection refer to; another value removes the selection.
    template <typename T> void setShape(T Parameters::*member, T value)
    {
        Parameters changed = p;
        if (changed.*member != value)
            changed.selection.release();
        changed.*member = value;
        replace(changed);
    }

    Parameters p;
    Ptr<const DescriptorPlan> plan;  //!< of p
    Ptr<Feature2D> detector;
};

//! Whether two matrices share memory: compute(image, keypoints, image) is legal.
bool overlap(const Mat& a, const Mat& b) { return a.datastart < b.dataend && b.datastart < a.dataend; }

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
    if (p.extraChannels == 1)
        joinRows(extra, image.size());
    checkKeyPoints(keypoints);
    if (image.empty())
    {
        descriptors.release();
        return;
    }
    checkImage(image);
    checkExtraChannels(extra, p.extraChannels, image.size());

    if (p.border == BORDER_DROP)
        keypoints.erase(std::remove_if(keypoints.begin(), keypoints.end(),
                                [&](const KeyPoint& kp) { return !isInside(*plan, kp, image.size()); }),
                keypoints.end());
    if (keypoints.empty())
    {
        descriptors.release();
        return;
    }

    descriptors.create((int)keypoints.size(), descriptorSize(), CV_8U);
    Mat result = descriptors.getMat();
    bool overwrites = overlap(result, image);
    for (const Mat& map : extra)
        overwrites = overwrites || overlap(result, map);
    Mat rows = overwrites ? Mat(result.size(), CV_8U) : result;
    describe(*plan, image, extra, keypoints, rows);
    if (overwrites)
        rows.copyTo(result);
}

void IIBDescriptorExtractor_Impl::write(FileStorage& fs) const
{
    // One node, which is then the first of a file: Algorithm::load() reads what Feature2D::write(file) wrote.
    fs << "IIB"
       << "{"
       << "format" << 1 << "scaleFactor" << p.scaleFactor << "granularity" << p.granularity << "channels"
       << p.channels << "mapping" << p.mapping << "overlap" << p.overlap << "useOrientation" << p.orientation
       << "extraChannels" << p.extraChannels << "border" << p.border;
    if (!p.selection.empty())
        fs << "selection" << std::vector<int>(p.selection.begin(), p.selection.end());
    fs << "detector"
       << "{";
    writeDetector(fs, *detector);
    fs << "}"
       << "}";
}

Mat_<int> readSelection(const FileNode& node)
{
    if (node.empty())
        return Mat_<int>();
    if (!node.isSeq() || node.size() % 5 != 0)
        CV_Error(Error::StsParseError, "the selection is " + describeNode(node) +
                                               "; it must be a sequence of rows of 5 whole numbers");
    Mat_<int> quads((int)node.size() / 5, 5);
    int i = 0;
    for (const FileNode& number : node)
    {
        quads(i / 5, i % 5) = numberOf<int>(number, format("number %d of the selection", i));
        i++;
    }
    return quads;
}

void IIBDescriptorExtractor_Impl::read(const FileNode& node)
{
    // The node that write() made, or what holds it: the root of a file, or a node around it.
    const FileNode inner = node.isMap() ? node["IIB"] : FileNode();
    const FileNode fn = inner.isMap() ? inner : node;
    const FileNode version = fn.isMap() ? fn["format"] : FileNode();
    if (version.empty())
        CV_Error(Error::StsParseError, "the node holds no IIB parameters: it is " + describeNode(node) +
                                               ", without a format; give it the node that write() wrote");
    int format = 0;
    readNumber(fn, "format", format);
    if (format != 1)
        CV_Error(Error::StsParseError,
                cv::format("the node has format %d; this version reads IIB parameters of format 1", format));
    Parameters r = p;
    readNumber(fn, "scaleFactor", r.scaleFactor);
    readNumber(fn, "granularity", r.granularity);
    readNumber(fn, "channels", r.channels);
    readNumber(fn, "mapping", r.mapping);
    readNumber(fn, "overlap", r.overlap);
    readNumber(fn, "useOrientation", r.orientation);  // 0 and 1 once were false and true
    readNumber(fn, "extraChannels", r.extraChannels);
    readNumber(fn, "border", r.border);
    r.selection = readSelection(fn["selection"]);
    r.check();                                     // before the detector reads
    const FileNode detectorNode = fn["detector"];  // not in files of the first versions
    const Ptr<Feature2D> d = detectorNode.empty() ? detector : readDetector(detectorNode, detector);
    replace(r);
    detector = d;
}

}  // namespace

Ptr<IIBDescriptorExtractor> IIBDescriptorExtractor::create(float scaleFactor, int granularity, int channels,
        int mapping, bool overlap, bool useOrientation, int extraChannels)
{
    const Parameters p = {scaleFactor, granularity, channels, mapping, overlap,
            useOrientation ? ORIENTATION_KEYPOINT : ORIENTATION_NONE, extraChannels, BORDER_REFLECT,
            Mat_<int>()};
    return makePtr<IIBDescriptorExtractor_Impl>(p);
}

}  // namespace iib
}  // namespace cv
