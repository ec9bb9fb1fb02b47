// SPDX-License-Identifier: Apache-2.0

#include "pose/robust_fit.hpp"
#include "two_cameras.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

const double MEDIAN = 4.351, OF_95 = 11.07, OF_99 = 15.09;  // of chi-squared with five degrees of freedom

//! Squared Mahalanobis lengths of the errors of estimated poses.
struct Coverage
{
    int trials;
    std::vector<double> squared;  //!< one for each accepted pose

    //! @param viewsOf makes the views of a pose. @param scale of findRelativePose.
    template <class ViewsOf>
    Coverage(RNG& random, int trials_, const ViewsOf& viewsOf, double scale = 0) : trials(trials_)
    {
        for (int trial = 0; trial < trials; trial++)
        {
            const RelativePose truth = randomPose(random, .2);
            const PoseResult result(viewsOf(truth), scale);
            if (result.found)
                squared.push_back(result.squared(truth));
        }
    }

    double found() const { return (double)squared.size() / trials; }
    //! The share of accepted poses within a limit.
    double within(double limit) const
    {
        return (double)std::count_if(squared.begin(), squared.end(), [&](double s) { return s < limit; }) /
               (double)squared.size();
    }
};

/* Here the matches' errors are independent. The covariance allows for errors that neighbours share, so it is larger than the errors,
but standard deviations are less than three times as large. */
TEST(RelativePose, covariance_predicts_independent_errors)
{
    RNG random(5);
    const Coverage coverage(
            random, 200, [&](const RelativePose& truth) { return Views(random, truth, 150, 20, .2); });
    EXPECT_EQ(1, coverage.found());
    EXPECT_LT(coverage.within(MEDIAN / 9), .45);
    EXPECT_GE(coverage.within(OF_99), .98);
}

// The noise of few matches is underestimated: five parameters are fitted to them, and at a narrow scale many poses fit.
TEST(RelativePose, covariance_predicts_errors_of_few_matches)
{
    for (int count : {10, 15, 25})
        for (double noise : {.1, .3, 1.})
        {
            SCOPED_TRACE(format("%d matches, noise %g", count, noise));
            RNG random(40);
            const Coverage coverage(random, count == 10 ? 400 : 100,
                    [&](const RelativePose& truth) { return Views(random, truth, count, 0, noise); });
            EXPECT_GE(coverage.found(), count == 10 ? .5 : .95);
            EXPECT_GE(coverage.within(MEDIAN),
                    count == 25 ? .9 : .8);  // .84 and .77 if the final fit leaves matches out
            EXPECT_GE(coverage.within(OF_95), noise < 1 ? .93 : .9);
            EXPECT_GE(coverage.within(OF_99), noise < 1 ? .94 : .92);
        }
}

//! All matches of a part of the image have the same error, such as by a shadow.
TEST(RelativePose, covariance_predicts_errors_that_neighbours_share)
{
    RNG random(8);
    const Coverage coverage(random, 100, [&](const RelativePose& truth) {
        Views views(random, truth, 200, 20, .1);
        Vec2d shifts[12];
        for (Vec2d& shift : shifts)
            random.fill(shift, RNG::NORMAL, 0, .2);
        for (size_t i = 0; i < views.points1.size(); i++)
        {
            const Point2d at = views.points1[i];
            const int part = std::clamp(int(at.x / 160), 0, 3) + 4 * std::clamp(int(at.y / 160), 0, 2);
            views.points2[i] += Point2d(shifts[part]);
        }
        return views;
    });
    EXPECT_EQ(1, coverage.found());
    EXPECT_GT(coverage.within(MEDIAN), .4);
    EXPECT_GT(coverage.within(OF_95), .8);
}

// Five parameters were fitted, so the degrees of freedom are five less.
TEST(RelativePose, a_scale_is_corrected_for_the_fitted_parameters)
{
    std::vector<double> squared(12, .01);
    double scale = 0;
    EXPECT_TRUE(findScale(squared, 1, 5, scale));
    EXPECT_NEAR(1.4826 * .1 * std::sqrt(12. / 7), scale, 1e-9);
    std::fill(squared.begin(), squared.begin() + 4, 4.);
    EXPECT_FALSE(findScale(squared, 1, 5, scale));
    EXPECT_FALSE(findScale(std::vector<double>(5, .01), 1, 5, scale));
}

// Without a scale, and with one that is far too narrow, the covariance comes from the residuals.
TEST(RelativePose, covariance_is_estimated_from_residuals_of_any_size)
{
    const struct
    {
        double scale, noise;
    } cases[] = {{0, 1}, {0, 3}, {0, 5}, {.25, .25}, {.25, 2}, {.25, 4}};
    for (const auto& c : cases)
    {
        SCOPED_TRACE(format("scale %g, noise %g", c.scale, c.noise));
        RNG random(22);
        const Coverage coverage(
                random, 30, [&](const RelativePose& truth) { return Views(random, truth, 150, 0, c.noise); },
                c.scale);
        EXPECT_GE(coverage.found(), c.scale == 0 ? 1 : .9);
        EXPECT_GE(coverage.within(MEDIAN), .6);
        EXPECT_GE(coverage.within(OF_95), .9);
    }
}

}}  // namespace opencv_test
