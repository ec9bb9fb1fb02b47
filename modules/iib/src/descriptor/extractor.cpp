// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/detector_file.hpp"
#include "../common/file_numbers.hpp"
#include "../common/image_input.hpp"
#include "plan.hpp"

#include "opencv2/core/utils/trace.hpp"
#include "opencv2/iib/detail/files.hpp"

namespace cv { namespace iib {

namespace {

//! The maps of extra channels. Throws unless there are `expected` of the image's size, each 8U, 16U or 32F and finite.
std::vector<Mat> extraMaps(InputArrayOfArrays arrays, int expected, Size imageSize)
{
    std::vector<Mat> maps;
    if (arrays.isMat() || arrays.isUMat())
        maps.push_back(arrays.getMat());  // not its rows
    else if (!arrays.empty())
        arrays.getMatVector(maps);
    if ((int)maps.size() != expected)
        CV_Error(Error::StsBadArg,
                format("%d extra channels were given to an extractor of %d; pass computeWithChannels "
                       "a list of maps, also of one, or change setExtraChannels",
                        (int)maps.size(), expected));
    for (size_t i = 0; i < maps.size(); i++)
    {
        const String what = format("extra channel %d", (int)i);
        if (maps[i].dims > 2 || maps[i].channels() != 1)
            CV_Error(Error::StsBadArg, what + format(" has %d channels; it must have 1", maps[i].channels()));
        if (maps[i].size() != imageSize)
            CV_Error(Error::StsUnmatchedSizes,
                    what + format(" is %d x %d; the image is %d x %d", maps[i].cols, maps[i].rows,
                                   imageSize.width, imageSize.height));
        checkPixels(maps[i], what);
    }
    return maps;
}

//! Whether matrices may share memory.
bool overlap(const Mat& a, const Mat& b) { return a.datastart < b.dataend && b.datastart < a.dataend; }

class IIBDescriptorExtractor_Impl CV_FINAL : public IIBDescriptorExtractor, public AnyImage
{
public:
    explicit IIBDescriptorExtractor_Impl(const Parameters& checked)
        : plan(makePlan(checked)), detector(ORB::create())
    {
    }

    void compute(InputArray image, std::vector<KeyPoint>& keypoints, OutputArray descriptors) CV_OVERRIDE
    {
        compute(image, noArray(), keypoints, descriptors);
    }

    void compute(InputArray imageArray, InputArrayOfArrays extraArrays, std::vector<KeyPoint>& keypoints,
            OutputArray descriptors) CV_OVERRIDE
    {
        CV_TRACE_FUNCTION();

        const Mat image = imageArray.getMat();
        checkKeyPoints(keypoints, plan->parameters.orientation == ORIENTATION_KEYPOINT);
        if (image.empty())
        {
            descriptors.release();
            return;
        }
        checkImage(image);
        const std::vector<Mat> extra = extraMaps(extraArrays, plan->parameters.extraChannels, image.size());

        if (plan->parameters.border == BORDER_DROP)
            keypoints.erase(std::remove_if(keypoints.begin(), keypoints.end(),
                                    [&](const KeyPoint& kp) { return !isInside(*plan, kp, image.size()); }),
                    keypoints.end());
        if (!descriptors.needed())
            return;
        if (keypoints.empty())
        {
            descriptors.release();
            return;
        }

        descriptors.create((int)keypoints.size(), descriptorSize(), CV_8U);
        const Mat result = descriptors.getMat();
        // not in memory that is still read
        Mat rows = overlap(result, image) || std::any_of(extra.begin(), extra.end(),
                                                     [&](const Mat& map) { return overlap(result, map); })
                           ? Mat(result.size(), CV_8U)
                           : result;
        describe(*plan, image, extra, keypoints, rows);
        if (rows.data != result.data)
            rows.copyTo(descriptors);
    }

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
    float getScaleFactor() const CV_OVERRIDE { return plan->parameters.scaleFactor; }
    void setGranularity(int value) CV_OVERRIDE { setShape(&Parameters::granularity, value); }
    int getGranularity() const CV_OVERRIDE { return plan->parameters.granularity; }
    void setChannels(int value) CV_OVERRIDE { setShape(&Parameters::channels, value); }
    int getChannels() const CV_OVERRIDE { return plan->parameters.channels; }
    void setMapping(int value) CV_OVERRIDE { setShape(&Parameters::mapping, value); }
    int getMapping() const CV_OVERRIDE { return plan->parameters.mapping; }
    void setOverlap(bool value) CV_OVERRIDE { setShape(&Parameters::overlap, value); }
    bool getOverlap() const CV_OVERRIDE { return plan->parameters.overlap; }
    void setUseOrientation(bool value) CV_OVERRIDE
    {
        setOrientation(value ? ORIENTATION_KEYPOINT : ORIENTATION_NONE);
    }
    bool getUseOrientation() const CV_OVERRIDE { return plan->parameters.orientation != ORIENTATION_NONE; }
    void setOrientation(int value) CV_OVERRIDE { set(&Parameters::orientation, value); }
    int getOrientation() const CV_OVERRIDE { return plan->parameters.orientation; }
    void setExtraChannels(int value) CV_OVERRIDE { setShape(&Parameters::extraChannels, value); }
    int getExtraChannels() const CV_OVERRIDE { return plan->parameters.extraChannels; }
    void setBorder(int value) CV_OVERRIDE { set(&Parameters::border, value); }
    int getBorder() const CV_OVERRIDE { return plan->parameters.border; }

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
        set(&Parameters::selection, q.empty() ? Mat_<int>() : Mat_<int>(q.clone()));
    }
    Mat getSelection() const CV_OVERRIDE { return plan->parameters.selection.clone(); }

    String getDefaultName() const CV_OVERRIDE { return Feature2D::getDefaultName() + ".IIB"; }
    using Feature2D::write;
    void write(FileStorage& fs) const CV_OVERRIDE
    {
        // one node, so that Algorithm::load() reads files of Feature2D::write(filename)
        fs << "IIB"
           << "{";
        writeParameters(fs, plan->parameters);
        fs << "detector"
           << "{";
        writeDetector(fs, *detector);
        fs << "}"
           << "}";
    }
    using Feature2D::read;
    void read(const FileNode& node) CV_OVERRIDE
    {
        const Parameters parameters = readParameters(node, plan->parameters);
        const FileNode detectorNode =
                nodeNamed(node, "IIB")["detector"];  // missing in files of the first versions
        const Ptr<Feature2D> d = detectorNode.empty() ? detector : readDetector(detectorNode, detector);
        plan = makePlan(parameters);
        detector = d;
    }
    void save(const String& filename) const CV_OVERRIDE { saveWhole(*this, filename); }

private:
    //! Whether `feature` is this extractor or contains it.
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

    void set(const Parameters& changed)
    {
        changed.check();
        plan = makePlan(changed);
    }

    template <typename T> void set(T Parameters::*member, const T& value)
    {
        Parameters changed = plan->parameters;
        changed.*member = value;
        set(changed);
    }

    //! Sets a parameter that the rows of a selection refer to; another value removes the selection.
    template <typename T> void setShape(T Parameters::*member, T value)
    {
        Parameters changed = plan->parameters;
        if (changed.*member != value)
            changed.selection.release();
        changed.*member = value;
        set(changed);
    }

    Ptr<const DescriptorPlan> plan;
    Ptr<Feature2D> detector;
};

}  // namespace

Ptr<IIBDescriptorExtractor> IIBDescriptorExtractor::create(float scaleFactor, int granularity, int channels,
        int mapping, bool overlap, bool useOrientation, int extraChannels)
{
    const Parameters p = {scaleFactor, granularity, channels, mapping, overlap,
            useOrientation ? ORIENTATION_KEYPOINT : ORIENTATION_NONE, extraChannels, BORDER_REFLECT,
            Mat_<int>()};
    p.check();
    return makePtr<IIBDescriptorExtractor_Impl>(p);
}

}}  // namespace cv::iib
