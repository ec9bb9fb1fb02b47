// SPDX-License-Identifier: Apache-2.0

#include "imu.hpp"

#include <algorithm>

namespace iib_localization {
namespace {

// Noise densities of a good MEMS sensor (EuRoC's sensor.yaml), twice as large for what the model leaves out.
constexpr double RATE_NOISE = 2 * 1.7e-4;   // rad/s/sqrt(Hz)
constexpr double FORCE_NOISE = 2 * 2.0e-3;  // m/s^2/sqrt(Hz)
constexpr int64_t MAX_GAP = 100000000;      // nanoseconds

Eigen::Quaterniond turnBy(const Eigen::Vector3d& vector)
{
    const double angle = vector.norm();
    return angle < 1e-12 ? Eigen::Quaterniond::Identity()
                         : Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
}

Eigen::Matrix3d cross(const Eigen::Vector3d& v)
{
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

//! How a rotation changes with its vector, to the right of it.
Eigen::Matrix3d rightJacobian(const Eigen::Vector3d& v)
{
    const double angle = v.norm();
    if (angle < 1e-6)
        return Eigen::Matrix3d::Identity() - 0.5 * cross(v);
    const Eigen::Matrix3d c = cross(v / angle);
    return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / angle * c +
           (1 - std::sin(angle) / angle) * c * c;
}

}  // namespace

void Preintegration::add(const Eigen::Vector3d& measuredRate, const Eigen::Vector3d& measuredForce, double dt)
{
    const Eigen::Vector3d turn = (measuredRate - bias.rate) * dt;
    const Eigen::Vector3d force = measuredForce - bias.force;
    // the force is taken in the axes of the middle of the step
    const Eigen::Matrix3d middle = (rotation * turnBy(turn / 2)).toRotationMatrix();
    const Eigen::Matrix3d step = turnBy(turn).toRotationMatrix();
    const Eigen::Matrix3d jacobian = rightJacobian(turn);
    const Eigen::Matrix3d forceByTurn = -middle * cross(force);
    const Eigen::Matrix3d halfStep = turnBy(turn / 2).toRotationMatrix().transpose();

    // rotation, velocity, position after the step by those before it, and by the readings
    Eigen::Matrix<double, 9, 9> byState = Eigen::Matrix<double, 9, 9>::Identity();
    byState.block<3, 3>(0, 0) = step.transpose();
    byState.block<3, 3>(3, 0) = forceByTurn * halfStep * dt;
    byState.block<3, 3>(6, 0) = forceByTurn * halfStep * dt * dt / 2;
    byState.block<3, 3>(6, 3) = Eigen::Matrix3d::Identity() * dt;
    Eigen::Matrix<double, 9, 6> byReading = Eigen::Matrix<double, 9, 6>::Zero();
    const Eigen::Matrix3d halfTurn = rightJacobian(turn / 2) * dt / 2;
    byReading.block<3, 3>(0, 0) = jacobian * dt;
    byReading.block<3, 3>(3, 0) = forceByTurn * halfTurn * dt;
    byReading.block<3, 3>(6, 0) = forceByTurn * halfTurn * dt * dt / 2;
    byReading.block<3, 3>(3, 3) = middle * dt;
    byReading.block<3, 3>(6, 3) = middle * dt * dt / 2;
    Eigen::Matrix<double, 6, 1> noise;
    noise << Eigen::Vector3d::Constant(RATE_NOISE * RATE_NOISE / dt),
            Eigen::Vector3d::Constant(FORCE_NOISE * FORCE_NOISE / dt);
    byBias = byState * byBias - byReading;
    covariance = byState * covariance * byState.transpose() +
                 byReading * noise.asDiagonal() * byReading.transpose();

    position += velocity * dt + middle * force * dt * dt / 2;
    velocity += middle * force * dt;
    rotation = (rotation * turnBy(turn)).normalized();
    seconds += dt;
}

bool preintegrate(const std::vector<ImuReading>& readings, int64_t from, int64_t to, const ImuBias& bias,
        Preintegration& result)
{
    result = Preintegration();
    result.bias = bias;
    if (readings.empty() || readings.front().nanoseconds > from || readings.back().nanoseconds < to)
        return false;
    const auto later = [](int64_t time, const ImuReading& r) { return time < r.nanoseconds; };
    auto next = std::upper_bound(readings.begin(), readings.end(), from, later);
    for (int64_t now = from; now < to; ++next)
    {
        const ImuReading &a = *(next - 1), &b = *next;
        const int64_t end = std::min(to, b.nanoseconds);
        if (b.nanoseconds - a.nanoseconds > MAX_GAP)
            return false;
        // the mean over the step of what is linear is its value in the middle
        const double share = (0.5 * double(now - a.nanoseconds) + 0.5 * double(end - a.nanoseconds)) /
                             double(b.nanoseconds - a.nanoseconds);
        result.add(a.rate + share * (b.rate - a.rate), a.force + share * (b.force - a.force),
                double(end - now) * 1e-9);
        now = end;
    }
    return true;
}

}  // namespace iib_localization
