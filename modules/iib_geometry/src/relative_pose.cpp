// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/relative_pose.hpp"

#include "epipolar_problem.hpp"

namespace cv::iib {
namespace {

//! N x 2, CV_64F.
Mat pixels(InputArray points, const char* name)
{
    const Mat given = points.getMat();
    if (given.empty())
        return Mat(0, 2, CV_64F);
    const int count = given.checkVector(2);
    if (count < 0 || (given.depth() != CV_32F && given.depth() != CV_64F))
        CV_Error(Error::StsBadArg,
                format("findRelativePose: %s must be N x 2 numbers, CV_32F or CV_64F", name));
    Mat rows;
    given.reshape(1, count).convertTo(rows, CV_64F);
    if (!checkRange(rows))
        CV_Error(Error::StsBadArg, format("findRelativePose: %s has numbers that are not finite", name));
    return rows;
}

Matx33d cameraMatrix(InputArray matrix, const char* name)
{
    const Mat given = matrix.getMat();
    bool good = given.dims == 2 && given.rows == 3 && given.cols == 3 && given.channels() == 1 &&
                (given.depth() == CV_32F || given.depth() == CV_64F);
    Matx33d K;
    if (good)
    {
        Mat doubles;
        given.convertTo(doubles, CV_64F);
        K = Matx33d(doubles);
        good = checkRange(doubles) && K(0, 0) > 0 && K(1, 1) > 0 && K(0, 1) == 0 && K(1, 0) == 0 &&
               K(2, 0) == 0 && K(2, 1) == 0 && K(2, 2) == 1;
    }
    if (!good)
        CV_Error(Error::StsBadArg, format("findRelativePose: %s must be 3 x 3, CV_32F or CV_64F, [fx 0 cx; 0 "
                                          "fy cy; 0 0 1] in pixels, with "
                                          "fx and fy over 0",
                                           name));
    return K;
}

}  // namespace

bool findRelativePose(InputArray points1, InputArray points2, InputArray cameraMatrix1,
        InputArray cameraMatrix2, OutputArray R, OutputArray t, OutputArray inliers, double scale,
        OutputArray covariance)
{
    const Mat first = pixels(points1, "points1"), second = pixels(points2, "points2");
    if (first.rows != second.rows)
        CV_Error(Error::StsUnmatchedSizes,
                format("findRelativePose: points1 has %d points, points2 %d; they must be "
                       "matches, one for one",
                        first.rows, second.rows));
    if (!(scale > 0) || cvIsInf(scale))
        CV_Error(Error::StsOutOfRange, "findRelativePose: scale, in pixels, must be over 0 and finite");
    const EpipolarProblem problem(first, second, cameraMatrix(cameraMatrix1, "cameraMatrix1"),
            cameraMatrix(cameraMatrix2, "cameraMatrix2"), scale);
    RelativePose pose;
    std::vector<uchar> agree;
    const bool found = robustFit(problem, pose, agree);
    if (inliers.needed())
        Mat(agree, true).copyTo(inliers);
    if (!found)
    {
        R.release();
        t.release();
        covariance.release();
        return false;
    }
    Mat(pose.R).copyTo(R);
    Mat(pose.t).copyTo(t);
    if (covariance.needed())
        Mat(covarianceOf(problem, pose)).copyTo(covariance);
    return true;
}

}  // namespace cv::iib
