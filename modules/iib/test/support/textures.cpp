// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "textures.hpp"

namespace opencv_test {

int Integers::below(int end)
{
    uint64 z = state += CV_BIG_UINT(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * CV_BIG_UINT(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * CV_BIG_UINT(0x94d049bb133111eb);
    return (int)((z ^ z >> 31) % (unsigned)end);
}

//! Binomial weights along rows or columns; the border is repeated.
static Mat_<int> blurred(const Mat_<int>& m, Point direction)
{
    static const int weights[] = {1, 4, 6, 4, 1};
    Mat_<int> result(m.size()), padded;
    cv::copyMakeBorder(m, padded, 2, 2, 2, 2, cv::BORDER_REPLICATE);
    for (int y = 0; y < m.rows; y++)
        for (int x = 0; x < m.cols; x++)
        {
            int sum = 8;
            for (int i = -2; i <= 2; i++)
                sum += weights[i + 2] * padded(y + 2 + i * direction.y, x + 2 + i * direction.x);
            result(y, x) = sum / 16;
        }
    return result;
}

Mat texture(Size size, int depth, int seed)
{
    CV_Assert(depth == CV_8U || depth == CV_16U);
    Integers integers(seed);
    Mat_<int> m(size);
    for (int& pixel : m)
        pixel = integers.below(depth == CV_8U ? 256 : 65536);
    if (size.width > 16 && size.height > 16)
    {
        m = blurred(blurred(m, Point(1, 0)), Point(0, 1));
        m(Rect(size.width / 4, size.height / 4, size.width / 3, size.height / 3)) = 77;
    }
    Mat result;
    m.convertTo(result, depth);
    return result;
}

std::vector<KeyPoint> scatter(Size size, int count, float smallest, float largest, int seed)
{
    Integers integers(seed);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < count; i++)
    {
        // a fourth of them on whole pixels
        const int part = i % 4 ? 4 : 1;
        const float x = integers.between(-size.width * part / 5, size.width * part * 6 / 5) / (float)part;
        const float y = integers.between(-size.height * part / 5, size.height * part * 6 / 5) / (float)part;
        const float angle = i % 5 ? (float)integers.below(360) : -1.f;
        keypoints.push_back(
                KeyPoint(x, y, integers.between((int)(smallest * 8), (int)(largest * 8)) / 8.f, angle));
    }
    return keypoints;
}

int differingBits(const Mat& a, const Mat& b)
{
    EXPECT_EQ(a.size(), b.size());
    EXPECT_EQ(a.type(), b.type());
    return a.size() == b.size() && !a.empty() ? cvRound(cvtest::norm(a, b, NORM_HAMMING)) : -1;
}

void expectSameKeyPoints(const std::vector<KeyPoint>& expected, const std::vector<KeyPoint>& actual)
{
    ASSERT_EQ(expected.size(), actual.size());
    for (size_t i = 0; i < expected.size(); i++)
    {
        EXPECT_EQ(expected[i].pt, actual[i].pt);
        EXPECT_EQ(expected[i].size, actual[i].size);
        EXPECT_EQ(expected[i].angle, actual[i].angle);
        EXPECT_EQ(expected[i].response, actual[i].response);
        EXPECT_EQ(expected[i].octave, actual[i].octave);
        EXPECT_EQ(expected[i].class_id, actual[i].class_id);
    }
}

uint64 hashOf(const Mat& m)
{
    uint64 hash = CV_BIG_UINT(0xcbf29ce484222325);
    for (int y = 0; y < m.rows; y++)
        for (size_t i = 0; i < m.cols * m.elemSize(); i++)
            hash = (hash ^ m.ptr(y)[i]) * CV_BIG_UINT(0x100000001b3);
    return hash;
}

}  // namespace opencv_test
