// SPDX-License-Identifier: Apache-2.0
#ifndef IIB_GEOMETRY_POLISH_HPP
#define IIB_GEOMETRY_POLISH_HPP

#include "epipolar_loss.hpp"

namespace cv {
namespace iib {

//! Lowers the loss by Levenberg and Marquardt's steps, at most `rounds`, and returns it.
double polish(const EpipolarLoss& loss, RelativePose& pose, int rounds);

//! Covariance of the numbers of `moved` at a minimum of the loss: that of an M-estimator (Huber 1981, equation 7.6.2).
Matx<double, 5, 5> covarianceOf(const EpipolarLoss& loss, const RelativePose& pose);

}  // namespace iib
}  // namespace cv

#endif
