// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/temporary_file.hpp"
#include "../support/test_errors.hpp"
#include "../support/describe.hpp"

namespace opencv_test { namespace {

void expectSame(const IIB& expected, const IIB& actual)
{
    EXPECT_EQ(expected.getScaleFactor(), actual.getScaleFactor());
    EXPECT_EQ(expected.getGranularity(), actual.getGranularity());
    EXPECT_EQ(expected.getChannels(), actual.getChannels());
    EXPECT_EQ(expected.getMapping(), actual.getMapping());
    EXPECT_EQ(expected.getOverlap(), actual.getOverlap());
    EXPECT_EQ(expected.getOrientation(), actual.getOrientation());
    EXPECT_EQ(expected.getExtraChannels(), actual.getExtraChannels());
    EXPECT_EQ(expected.getBorder(), actual.getBorder());
    ASSERT_EQ(expected.getSelection().size(), actual.getSelection().size());
    EXPECT_TRUE(expected.getSelection().empty() ||
                cvtest::norm(expected.getSelection(), actual.getSelection(), NORM_INF) == 0);
}

Mat_<int> someQuads() { return Mat_<int>({3, 5}, {1, 2, 0, 0, 255, 3, 0, 5, 6, 9, 3, 3, 0, 2, 64}); }

//! No parameter has its default value.
Ptr<IIB> unusual()
{
    const Ptr<IIB> iib = IIB::create(64.f / 7, 5, 35, IIB::MAPPING_SORT, true, true, 3);
    iib->setBorder(IIB::BORDER_DROP);
    iib->setSelection(someQuads());
    return iib;
}

TEST(IIB_IO, file_holds_every_parameter)
{
    const Ptr<IIB> plain = IIB::create(), gradient = unusual();
    gradient->setOrientation(IIB::ORIENTATION_GRADIENT);
    for (const Ptr<IIB>& iib : {unusual(), gradient, plain})
        forEachFileOf<Feature2D>(*iib, [&](const String& file) {
            const Ptr<IIB> loaded = Algorithm::load<IIB>(file);
            ASSERT_FALSE(!loaded);
            expectSame(*iib, *loaded);
            const Ptr<IIB> other = iib == plain ? unusual() : IIB::create(1.f, 2);
            static_cast<Feature2D&>(*other).read(file);
            expectSame(*iib, *other);
        });
}

//! A file as the first version wrote format 1; later versions must read it.
const char FORMAT_1[] =
        "%YAML:1.0\n---\nIIB:\n   format: 1\n   scaleFactor: 9.1428575515747070e+00\n   granularity: 5\n"
        "   channels: 35\n   mapping: 4\n   overlap: 1\n   useOrientation: 1\n   extraChannels: 3\n"
        "   border: 1\n   selection: [ 1, 2, 0, 0, 255, 3, 0, 5, 6, 9, 3, 3, 0, 2, 64 ]\n";

TEST(IIB_IO, format_1_is_read)
{
    const Ptr<IIB> iib = Algorithm::loadFromString<IIB>(FORMAT_1);
    ASSERT_FALSE(!iib);
    expectSame(*unusual(), *iib);
}

TEST(IIB_IO, foreign_and_damaged_nodes_throw_and_change_nothing)
{
    const Ptr<IIB> iib = unusual();
    EXPECT_THROW(iib->read(FileNode()), cv::Exception);
    const char* replacements[][2] = {{"format: 1", "format: 2"}, {"format: 1", "formal: 1"},
            {"format: 1", "format: one"}, {"scaleFactor: 9", "scaleFactor: -9"},
            {"scaleFactor: 9", "scaleFactor: .NaN # 9"}, {"scaleFactor: 9", "scaleFactor: large # 9"},
            {"granularity: 5", "granularity: 9"}, {"granularity: 5", "granularity: five"},
            {"granularity: 5", "granularity: 2"}, {"channels: 35", "channels: 64"},
            {"mapping: 4", "mapping: SORT"}, {"overlap: 1", "overlap: yes"},
            {"useOrientation: 1", "useOrientation: [ 1 ]"}, {"extraChannels: 3", "extraChannels: 17"},
            {"border: 1", "border: 3"}, {"[ 1, 2,", "[ 1,"}, {"[ 1, 2,", "[ 1, 99,"},
            {"[ 1, 2,", "[ 1, two,"}, {"granularity: 5", "granularity: 3.6"}, {"format: 1", "format: 1.2"},
            {"granularity: 5", "granularity: 4294967299."}, {"[ 1, 2,", "[ 1, 4294967298.,"},
            {"overlap: 1", "overlap: 2"}, {"overlap: 1", "overlap: \"false\""}, {"[ 1, 2,", "[ 1, 2.5,"},
            {"[ 1, 2, 0, 0, 255, 3, 0, 5, 6, 9, 3, 3, 0, 2, 64 ]", "7"}};
    for (const auto& r : replacements)
    {
        const String damaged = replaced(FORMAT_1, r[0], r[1]);
        EXPECT_THROW(Algorithm::loadFromString<IIB>(damaged), cv::Exception) << r[1];
        const FileStorage fs(damaged, FileStorage::READ | FileStorage::MEMORY);
        EXPECT_THROW(iib->read(fs["IIB"]), cv::Exception) << r[1];
        expectSame(*unusual(), *iib);
    }
    EXPECT_THROW(Algorithm::loadFromString<IIB>("%YAML:1.0\n---\nBRISK:\n   threshold: 30\n"), cv::Exception);
}

#ifdef __linux__
TEST(IIB_IO, parameters_on_a_full_disk_keep_the_old_file)
{
    const TemporaryFolder folder;
    const Ptr<Algorithm> savers[] = {IIB::createPreset(IIB::PRESET_S512), HierarchicalMatcher::create({2, 6}),
            HessianDetector::create(), NormalizedDetector::create(ORB::create())};
    for (const char* extension : {".yml", ".xml", ".json"})
        for (const Ptr<Algorithm>& saver : savers)
        {
            const String name = folder.name + "/parameters" + extension;
            saver->save(name);
            const std::string before = readFile(name);
            ASSERT_GT(before.size(), 60u);
            {
                const FullDisk full(50);
                EXPECT_THROW(saver->save(name), cv::Exception) << name;
            }
            EXPECT_EQ(before, readFile(name));
        }
}
#endif

//! Every detector that a file can hold, with unusual parameters.
std::vector<Ptr<Feature2D>> detectors()
{
    const Ptr<ORB> orb = ORB::create(321, 1.3f, 5, 17, 1, 3, ORB::FAST_SCORE, 25, 9);
    return {orb, NormalizedDetector::create(orb, 7.5f),
            NormalizedDetector::create(NormalizedDetector::create(orb))};
}

String parametersOf(const Ptr<Feature2D>& detector)
{
    const Ptr<IIB> iib = IIB::create();
    iib->setDetector(detector);
    FileStorage fs(".yml", FileStorage::WRITE | FileStorage::MEMORY);
    iib->write(fs);
    return fs.releaseAndGetString();
}

TEST(IIB_DetectorFile, a_loaded_extractor_has_the_detector)
{
    const Mat image = scene(Size(320, 240), 1);
    for (const Ptr<Feature2D>& detector : detectors())
    {
        SCOPED_TRACE(detector->getDefaultName());
        const String text = parametersOf(detector);
        const Ptr<IIB> loaded = Algorithm::loadFromString<IIB>(text);
        EXPECT_EQ(detector->getDefaultName(), loaded->getDetector()->getDefaultName());
        EXPECT_EQ(text, parametersOf(loaded->getDetector()));

        expectSameKeyPoints(found(*detector, image), found(*loaded, image));
    }
}

TEST(IIB_DetectorFile, reading_leaves_the_callers_detector_alone)
{
    const Ptr<ORB> mine = ORB::create(10);
    const Ptr<IIB> iib = IIB::create();
    iib->setDetector(mine);
    const FileStorage fs(parametersOf(ORB::create(20)), FileStorage::READ | FileStorage::MEMORY);
    iib->read(fs["IIB"]);
    EXPECT_EQ(10, mine->getMaxFeatures());
    EXPECT_EQ(20, iib->getDetector().dynamicCast<ORB>()->getMaxFeatures());
}

//! A detector that this library does not know.
class OwnDetector : public Feature2D
{
public:
    explicit OwnDetector(int parameter_ = 0, const String& name_ = "Own") : parameter(parameter_), name(name_)
    {
    }
    String getDefaultName() const CV_OVERRIDE { return "Feature2D." + name; }
    using Feature2D::write;
    void write(FileStorage& fs) const CV_OVERRIDE { fs << "parameter" << parameter; }
    using Feature2D::read;
    void read(const FileNode& fn) CV_OVERRIDE { parameter = (int)fn["parameter"]; }

    int parameter;
    const String name;
};

TEST(IIB_DetectorFile, an_unknown_detector_reads_its_parameters_or_is_an_error)
{
    for (const bool wrapped : {false, true})
    {
        const Ptr<Feature2D> written = makePtr<OwnDetector>(5);
        const String text =
                parametersOf(wrapped ? Ptr<Feature2D>(NormalizedDetector::create(written)) : written);
        expectError(Error::StsParseError, "Feature2D.Own", [&] { Algorithm::loadFromString<IIB>(text); });

        const FileStorage fs(text, FileStorage::READ | FileStorage::MEMORY);
        const Ptr<OwnDetector> mine = makePtr<OwnDetector>();
        const Ptr<IIB> iib = IIB::create();
        iib->setDetector(wrapped ? Ptr<Feature2D>(NormalizedDetector::create(mine)) : Ptr<Feature2D>(mine));
        iib->read(fs["IIB"]);
        EXPECT_EQ(5, mine->parameter);
    }
}

// OpenCV's own detectors do not write all their parameters.
TEST(IIB_DetectorFile, detectors_of_other_classes_are_set_before_reading)
{
    for (const Ptr<Feature2D>& detector : {Ptr<Feature2D>(SIFT::create()),
                 Ptr<Feature2D>(GFTTDetector::create()), Ptr<Feature2D>(FastFeatureDetector::create())})
    {
        SCOPED_TRACE(detector->getDefaultName());
        const String text = parametersOf(detector);
        expectError(Error::StsParseError, "setDetector(), then read()",
                [&] { Algorithm::loadFromString<IIB>(text); });
        const FileStorage fs(text, FileStorage::READ | FileStorage::MEMORY);
        const Ptr<IIB> iib = IIB::create();
        iib->setDetector(detector);
        iib->read(fs["IIB"]);
        EXPECT_EQ(detector, iib->getDetector());
    }
}

TEST(IIB_DetectorFile, another_class_of_the_same_name)
{
    const String text = parametersOf(makePtr<OwnDetector>(0, "ORB"));
    expectError(Error::StsParseError, "the ORB detector's", [&] { Algorithm::loadFromString<IIB>(text); });
}

TEST(IIB_DetectorFile, damage_throws_and_changes_nothing)
{
    const String good = parametersOf(NormalizedDetector::create(ORB::create(321), 7.5f));
    const char* replacements[][2] = {{"maxFeatures: 321", "maxFeatures: many # "},
            {"maxFeatures: 321", "maxFeatures: 3.7 # "}, {"maxFeatures: 321", "maxFeatures: 1e300 # "},
            {"maxFeatures", "minFeatures"}, {"class: \"Feature2D.ORB\"", "class: 5"},
            {"class: \"Feature2D.ORB\"", "glass: \"Feature2D.ORB\""}, {"sigma: 7.5", "sigma: -7.5"},
            {"sigma: 7.5", "sigma: wide # 7.5"}};
    for (const auto& r : replacements)
    {
        const Ptr<Feature2D> mine = AKAZE::create();
        const Ptr<IIB> iib = IIB::create(3.5f);
        iib->setDetector(mine);
        const FileStorage fs(replaced(good, r[0], r[1]), FileStorage::READ | FileStorage::MEMORY);
        EXPECT_THROW(iib->read(fs["IIB"]), cv::Exception) << r[1];
        EXPECT_EQ(mine, iib->getDetector()) << r[1];
        EXPECT_EQ(3.5f, iib->getScaleFactor()) << r[1];
    }
}

}}  // namespace opencv_test
