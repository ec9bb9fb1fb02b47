// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pose/robust_fit.hpp"
#include "test_precomp.hpp"

namespace opencv_test {

typedef std::vector<double> Numbers;

/** Checks analytic derivatives against central differences.
@param analytic one row a value, one column a coordinate of the step.
@param valuesAt returns the finite values after a step.
@param tolerance relative to 1 plus the derivative. */
template <class ValuesAt>
void expectDerivatives(
        const Mat_<double>& analytic, const ValuesAt& valuesAt, double tolerance, double h = 1e-6)
{
    for (int k = 0; k < analytic.cols; k++)
    {
        Numbers step(analytic.cols);
        step[k] = h;
        const Numbers up = valuesAt(step);
        step[k] = -h;
        const Numbers down = valuesAt(step);
        ASSERT_EQ(size_t(analytic.rows), up.size());
        ASSERT_EQ(size_t(analytic.rows), down.size());
        for (int i = 0; i < analytic.rows; i++)
            ASSERT_NEAR(
                    (up[i] - down[i]) / (2 * h), analytic(i, k), tolerance * (1 + std::abs(analytic(i, k))))
                    << "value " << i << " by number " << k;
    }
}

//! Checks the rows of a Problem of robust_fit.hpp, and its loss, whose derivatives follow from the rows.
template <class Problem>
void expectDerivatives(
        const Problem& problem, const typename Problem::Model& model, double scale, double tolerance)
{
    typedef typename Problem::Step Step;
    std::vector<cv::iib::Row<Step>> rows;
    problem.linearize(model, DBL_MAX, rows);
    ASSERT_FALSE(rows.empty());
    Mat_<double> analytic(int(rows.size()) + 1, problem.parameters(), 0.);
    for (size_t i = 0; i < rows.size(); i++)
        for (int k = 0; k < analytic.cols; k++)
        {
            analytic(int(i), k) = rows[i].J[k];
            if (rows[i].r2 < cv::iib::FARTHEST * scale * scale)
                analytic(analytic.rows - 1, k) += 2 * rows[i].r / (scale * scale + rows[i].r2) * rows[i].J[k];
        }
    const auto valuesAt = [&](const Numbers& numbers) {
        Step step;
        std::copy(numbers.begin(), numbers.end(), step.val);
        const typename Problem::Model there = problem.moved(model, step);
        problem.linearize(there, DBL_MAX, rows);
        Numbers values;
        for (const cv::iib::Row<Step>& row : rows)
            values.push_back(row.r);
        values.push_back(problem.loss(there, cv::iib::Loss{scale}, DBL_MAX));
        return values;
    };
    expectDerivatives(analytic, valuesAt, tolerance);
}

}  // namespace opencv_test
