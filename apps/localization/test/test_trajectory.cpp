// SPDX-License-Identifier: Apache-2.0

#include "iib_geometry/test/test_folder.hpp"
#include "trajectory.hpp"

namespace {
using namespace iib_localization;
using cv::iib::ImuReading;

TEST(Imu, reads_euroc)
{
    const TestFolder folder;
    const std::string path = folder.path("imu.csv");
    folder.write("imu.csv", "#timestamp [ns],w_x\n0,0.1,-0.2,0.3,1,2,9.81\r\n5000000,0,0,0,1e-3,0,0\n");
    const std::vector<ImuReading> readings = readImu(path);
    ASSERT_EQ(2u, readings.size());
    EXPECT_EQ(5000000, readings[1].nanoseconds);
    EXPECT_EQ(cv::Vec3d(0.1, -0.2, 0.3), readings[0].rate);
    EXPECT_EQ(cv::Vec3d(1, 2, 9.81), readings[0].force);
    for (const char* wrong : {"5,0,0,,0,0,0", "5,0,0,0,0,0", "5,0,0,0,0,0,0,0", "x,0,0,0,0,0,0", ""})
    {
        folder.write("imu.csv", std::string("# of an IMU\n") + wrong + "\n");
        EXPECT_EQ(*wrong ? path + ":2: not a time and six numbers" : path + " has no readings",
                messageOf([&] { readImu(path); }))
                << wrong;
    }
    for (const char* time : {"9.3e18", "-9.3e18", "1e300"})
    {
        folder.write("imu.csv", std::string(time) + ",0,0,0,0,0,0\n");
        EXPECT_EQ(path + ":1: the time is not in nanoseconds", messageOf([&] { readImu(path); })) << time;
    }
    folder.write("imu.csv", "5,0,0,0,0,0,0\n5,0,0,0,0,0,0\n");
    EXPECT_EQ(path + ":2: the time does not rise", messageOf([&] { readImu(path); }));
}

TEST(Imu, names_that_are_times)
{
    EXPECT_EQ(1500000000, *nanoseconds("01.500000"));
    EXPECT_EQ(1403636579763555584, *nanoseconds("1403636579763555584"));
    EXPECT_EQ(1403636579763555584, *nanoseconds("1403636579.763555584"));
    EXPECT_EQ(3000000000, *nanoseconds("0003"));
    EXPECT_FALSE(nanoseconds("left_0003"));
    // differences would overflow; milliseconds
    for (const char* other : {"9999999999999999999", "9223372036854775807", "1403636579763", "99999999999"})
        EXPECT_FALSE(nanoseconds(other));
    EXPECT_FALSE(nanoseconds(""));
}

}  // namespace
