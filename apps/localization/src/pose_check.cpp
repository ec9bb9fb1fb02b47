// SPDX-License-Identifier: Apache-2.0

#include "pose_check.hpp"

#include "opencv2/calib3d.hpp"

#include "tracks.hpp"

namespace iib_localization {
namespace {

constexpr size_t PAIRS = 200;          // of keyframes, at most so many are checked
constexpr int MIN_INLIERS = 15;        // of an epipolar geometry, and
constexpr double MIN_SHARE = 0.3;      // of the matches: fewer agree by chance
constexpr double MATCH_ERROR = 2;      // pixels from an epipolar line of the matches' own geometry
constexpr double POSE_ERROR = 4;       // and of the poses'
constexpr double MIN_BASELINE = 1e-6;  // cameras at one place have no epipolar geometry

//! Maps pixels of the first keyframe to epipolar lines of the second.
Eigen::Matrix3d fundamental(const Pose& a, const Pinhole& cameraA, const Pose& b, const Pinhole& cameraB)
{
    const auto inverse = [](const Pinhole& p) {
        Eigen::Matrix3d k;
        k << 1 / p.fx, 0, -p.cx / p.fx, 0, 1 / p.fy, -p.cy / p.fy, 0, 0, 1;
        return k;
    };
    const Eigen::Vector3d t = b.toCamera(a.position).normalized();
    Eigen::Matrix3d across;
    across << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
    return inverse(cameraB).transpose() * across * (b.rotation.conjugate() * a.rotation).toRotationMatrix() *
           inverse(cameraA);
}

double lineDistance(const Eigen::Matrix3d& f, const cv::Point2d& a, const cv::Point2d& b)
{
    const Eigen::Vector3d line = f * Eigen::Vector3d(a.x, a.y, 1);
    return std::abs(line.dot(Eigen::Vector3d(b.x, b.y, 1))) / line.head<2>().norm();
}

}  // namespace

double poseAgreement(const FeatureMethod& method, const std::vector<Features>& features, const Model& model)
{
    const auto camera = [&](int k) { return model.cameras.at(model.keyframes[size_t(k)].camera); };
    const std::set<std::pair<int, int>> near = nearPairs(model.keyframes);
    const std::vector<std::pair<int, int>> pairs(near.begin(), near.end());
    int inliers = 0, agreeing = 0;
    for (size_t n = 0; n < pairs.size(); n += pairs.size() / PAIRS + 1)
    {
        const auto [i, j] = pairs[n];
        const Pose &a = model.keyframes[size_t(i)].pose, &b = model.keyframes[size_t(j)].pose;
        if ((a.position - b.position).norm() < MIN_BASELINE)
            continue;
        const std::vector<Eigen::Vector2d> pixelsA = camera(i).undistorted(features[size_t(i)].pixels),
                                           pixelsB = camera(j).undistorted(features[size_t(j)].pixels);
        std::vector<cv::Point2d> inA, inB;
        for (const cv::DMatch& m : method.match(features[size_t(i)], features[size_t(j)], method.sureRatio()))
        {
            inA.emplace_back(pixelsA[size_t(m.queryIdx)].x(), pixelsA[size_t(m.queryIdx)].y());
            inB.emplace_back(pixelsB[size_t(m.trainIdx)].x(), pixelsB[size_t(m.trainIdx)].y());
        }
        cv::Mat mask;
        if (inA.size() >= size_t(MIN_INLIERS))
            cv::findFundamentalMat(inA, inB, cv::USAC_MAGSAC, MATCH_ERROR, 0.999, 1000, mask);
        const int own = mask.empty() ? 0 : cv::countNonZero(mask);
        if (own < MIN_INLIERS || own < MIN_SHARE * double(inA.size()))
            continue;
        const Eigen::Matrix3d f = fundamental(a, camera(i).pinhole(), b, camera(j).pinhole());
        inliers += own;
        for (size_t m = 0; m < inA.size(); m++)
            agreeing += mask.at<uchar>(int(m)) != 0 && lineDistance(f, inA[m], inB[m]) < POSE_ERROR;
    }
    return inliers == 0 ? 1 : double(agreeing) / inliers;
}

}  // namespace iib_localization
