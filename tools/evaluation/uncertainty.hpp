// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "opencv2/core.hpp"
#include "opencv2/iib/verdict.hpp"
#include "results.hpp"

namespace iib_tools {

//! Probabilities of confidence limits.
const double LEVELS[] = {.1, .25, .5, .75, .9, .95, .99};

//! An estimate's error beside its reported covariance.
struct JudgedError
{
    double squared;       //!< Mahalanobis distance; infinite where the covariance allows no error
    double logDeviation;  //!< logarithm of the geometric mean of the reported standard deviations
    double score;  //!< logarithm of the reported density, of Student's t as of confidenceLimit, at the error
};

template <int N> JudgedError judged(const cv::Vec<double, N>& error, const cv::Matx<double, N, N>& covariance)
{
    cv::Vec<double, N> variances;
    cv::Matx<double, N, N> axes;
    cv::eigen(covariance, variances, axes);
    const cv::Vec<double, N> along = axes * error;
    JudgedError result = {0, 0, 0};
    for (int k = 0; k < N; k++)
    {
        if (along[k] != 0)
            result.squared += variances[k] > 0 ? along[k] * along[k] / variances[k]
                                               : std::numeric_limits<double>::infinity();
        result.logDeviation += std::log(variances[k]) / (2 * N);
    }
    const double twice = cv::iib::confidenceLimit(.5, 2);  // the scale matrix, in parts of the covariance
    result.score = std::lgamma((N + 2) / 2.) - N / 2. * std::log(CV_PI * twice) - N * result.logDeviation -
                   (N + 2) / 2. * std::log1p(result.squared / twice);
    return result;
}

//! Rows of a table, one for each quantity of a pair or an image.
class ErrorRows
{
public:
    //! @param names columns that name the pair or image
    static Fields columns(const Fields& names)
    {
        Fields all = with(names, "quantity", "count");
        for (double level : LEVELS)
            all.push_back(text(level));
        return with(all, "log_deviation", "score");
    }

    ErrorRows(ResultTable& table_, const Fields& name_) : table(table_), name(name_) {}

    //! Counts the errors within the limit of each level, and sums deviations and scores.
    void add(const std::string& quantity, const std::vector<JudgedError>& errors, int dimensions) const
    {
        Fields row = with(name, quantity, errors.size());
        for (double level : LEVELS)
            row.push_back(
                    std::to_string(std::count_if(errors.begin(), errors.end(), [&](const JudgedError& error) {
                        return error.squared < cv::iib::confidenceLimit(level, dimensions);
                    })));
        double logDeviation = 0, score = 0;
        for (const JudgedError& error : errors)
        {
            logDeviation += error.logDeviation;
            score += error.score;
        }
        table.append(with(row, logDeviation, score));
    }

private:
    ResultTable& table;
    Fields name;
};

//! The error of a direction as angles about the axes of findRelativePose's documentation.
inline cv::Vec2d alongTangents(const cv::Vec3d& found, const cv::Vec3d& truth)
{
    int shortest = 0;
    for (int k = 1; k < 3; k++)
        if (std::abs(found[k]) < std::abs(found[shortest]))
            shortest = k;
    cv::Vec3d axis;
    axis[shortest] = 1;
    const cv::Vec3d b = cv::normalize(found.cross(axis)), c = found.cross(b);
    const cv::Vec2d along(b.dot(truth), c.dot(truth));
    const double sine = cv::norm(along), angle = std::atan2(sine, found.dot(truth));
    return sine > 0 ? along * (angle / sine) : cv::Vec2d(angle, 0);  // opposite: any axis
}

//! Rotations of two cameras after which R = I and t is a unit vector along the x axis.
struct Rectification
{
    cv::Matx33d first, second;
    cv::Vec3d t;
};

//! Rectifies cameras that do not look along their baseline. @param R, t from the first's axes to the second's
inline Rectification rectificationOf(const cv::Matx33d& R, const cv::Vec3d& t)
{
    const cv::Vec3d way = cv::normalize(-(R.t() * t)),
                    ahead = cv::Vec3d(0, 0, 1) + R.t() * cv::Vec3d(0, 0, 1);
    const double side = way[0] < 0 ? -1 : 1;
    const cv::Vec3d x = side * way, y = cv::normalize(ahead.cross(x)), z = x.cross(y);
    const cv::Matx33d turn(x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2]);
    return {turn, turn * R.t(), cv::Vec3d(-side, 0, 0)};
}

}  // namespace iib_tools
