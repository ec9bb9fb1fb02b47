// SPDX-License-Identifier: Apache-2.0
#include "polish.hpp"

#include <algorithm>
#include <limits>

namespace cv {
namespace iib {
namespace {

const double FIRST_DAMPING = 1e-3, LESS = .1, MORE = 10, MOST = 1e6;
const double FLOOR = 1e-12;      // of the diagonal, where matches do not tell a number at all
const double LEAST_SLOPE = .05;  // of psi, on average: noise far over the scale
const double ENOUGH = 1e-9;      // relative decrease of the loss at which it has converged

typedef Matx<double, 5, 5> Square;

//! Adds weight J J' to the lower triangle.
void accumulate(const EpipolarLoss::Step& J, double weight, Square& sum)
{
    for (int a = 0; a < 5; a++)
        for (int b = 0; b <= a; b++)
            sum(a, b) += weight * J[a] * J[b];
}

void mirror(Square& sum)
{
    for (int a = 0; a < 5; a++)
    {
        sum(a, a) += FLOOR;
        for (int b = a + 1; b < 5; b++)
            sum(a, b) = sum(b, a);
    }
}

}  // namespace

double polish(const EpipolarLoss& loss, RelativePose& pose, int rounds)
{
    const double unlimited = std::numeric_limits<double>::max();
    double best = loss.at(essentialOf(pose), unlimited), damping = FIRST_DAMPING;
    std::vector<EpipolarLoss::Row> rows;
    for (int round = 0; round < rounds; round++)
    {
        loss.linearize(pose, rows);
        Square hessian = Square::zeros();
        EpipolarLoss::Step gradient, step;
        for (const EpipolarLoss::Row& row : rows)
        {
            const double weight = 1 / (1 + row.r * row.r);
            accumulate(row.J, weight, hessian);
            gradient += weight * row.r * row.J;
        }
        mirror(hessian);
        bool lower = false;
        const double before = best;
        for (; !lower && damping < MOST; damping *= lower ? LESS : MORE)
        {
            Square damped = hessian;
            for (int k = 0; k < 5; k++)
                damped(k, k) *= 1 + damping;
            solve(damped, gradient, step, DECOMP_CHOLESKY);
            const RelativePose next = moved(pose, -step);
            const double loss2 = loss.at(essentialOf(next), best);
            lower = loss2 < best;
            if (lower)
            {
                pose = next;
                best = loss2;
            }
        }
        if (!lower || before - best < ENOUGH * before)
            break;
    }
    return best;
}

Matx<double, 5, 5> covarianceOf(const EpipolarLoss& loss, const RelativePose& pose)
{
    std::vector<EpipolarLoss::Row> rows;
    loss.linearize(pose, rows);
    Square sum = Square::zeros();
    double influence2 = 0, slope = 0;  // of psi = r / (1 + r^2)
    for (const EpipolarLoss::Row& row : rows)
    {
        const double r2 = row.r * row.r, weight = 1 / (1 + r2);
        accumulate(row.J, 1, sum);
        influence2 += r2 * weight * weight;
        slope += (1 - r2) * weight * weight;
    }
    mirror(sum);
    const double count = (double)rows.size(), most = std::max(slope, LEAST_SLOPE * count);
    return sum.inv(DECOMP_CHOLESKY) * (influence2 * count / (most * most) * count / std::max(count - 5, 1.));
}

}  // namespace iib
}  // namespace cv
