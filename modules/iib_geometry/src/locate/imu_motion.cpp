// SPDX-License-Identifier: Apache-2.0

#include "imu_motion.hpp"

#include <algorithm>

#include "../pose/two_views.hpp"

namespace cv::iib {
namespace {

// Noise densities of a good MEMS sensor (EuRoC's sensor.yaml), doubled for unmodelled errors.
constexpr double RATE_NOISE = 2 * 1.7e-4;              // rad/s/sqrt(Hz)
constexpr double FORCE_NOISE = 2 * 2.0e-3;             // m/s^2/sqrt(Hz)
constexpr double RATE_WALK = 1e-4, FORCE_WALK = 2e-3;  // of the biases, per root second
// Variances that the parts of an error gain in a second.
constexpr double NOISE[] = {RATE_NOISE * RATE_NOISE, 0, FORCE_NOISE* FORCE_NOISE, RATE_WALK* RATE_WALK,
        FORCE_WALK* FORCE_WALK, 0};
constexpr int64 MAX_GAP = 100000000;  // nanoseconds between readings

Matx33d turnBy(const Vec3d& vector) { return Affine3d(vector).rotation(); }

Vec3d part(const ImuState::Errors& error, int begin) { return Vec3d(error.val + begin); }

}  // namespace

ImuState plus(const ImuState& s, const ImuState::Errors& e)
{
    return {turnBy(part(e, ImuState::TURN)) * s.rotation, s.position + part(e, ImuState::POSITION),
            s.velocity + part(e, ImuState::VELOCITY), s.rate + part(e, ImuState::RATE),
            s.force + part(e, ImuState::FORCE), s.gravity + part(e, ImuState::DOWN)};
}

ImuState::Errors minus(const ImuState& a, const ImuState& b)
{
    ImuState::Errors e;
    const Vec3d parts[] = {Affine3d(a.rotation * b.rotation.t(), Vec3d()).rvec(), a.position - b.position,
            a.velocity - b.velocity, a.rate - b.rate, a.force - b.force, a.gravity - b.gravity};
    for (int i = 0; i < ImuState::SIZE; i++)
        e[i] = parts[i / 3][i % 3];
    return e;
}

void advance(ImuState& s, const Vec3d& rate, const Vec3d& force, double dt, ImuState::Matrix& change)
{
    const Vec3d turn = (rate - s.rate) * dt;
    const Matx33d middle = s.rotation * turnBy(turn / 2), one = Matx33d::eye();
    const Vec3d worldForce = middle * (force - s.force);
    change = ImuState::Matrix::eye();
    setBlock(change, ImuState::TURN, ImuState::RATE, -dt * middle);
    setBlock(change, ImuState::POSITION, ImuState::TURN, -dt * dt / 2 * crossProduct(worldForce));
    setBlock(change, ImuState::POSITION, ImuState::VELOCITY, dt * one);
    setBlock(change, ImuState::POSITION, ImuState::FORCE, -dt * dt / 2 * middle);
    setBlock(change, ImuState::POSITION, ImuState::DOWN, dt * dt / 2 * one);
    setBlock(change, ImuState::VELOCITY, ImuState::TURN, -dt * crossProduct(worldForce));
    setBlock(change, ImuState::VELOCITY, ImuState::FORCE, -dt * middle);
    setBlock(change, ImuState::VELOCITY, ImuState::DOWN, dt * one);
    const Vec3d acceleration = worldForce + s.gravity;
    s.position += s.velocity * dt + acceleration * (dt * dt / 2);
    s.velocity += acceleration * dt;
    s.rotation = s.rotation * turnBy(turn);
}

bool integrate(const std::vector<ImuReading>& readings, int64 from, int64 to, ImuState& state,
        ImuState::Matrix* covariance, ImuState::Matrix* change)
{
    if (covariance)
        *change = ImuState::Matrix::eye();
    if (readings.empty() || readings.front().nanoseconds > from || readings.back().nanoseconds < to)
        return false;
    const auto later = [](int64 time, const ImuReading& r) { return time < r.nanoseconds; };
    auto next = std::upper_bound(readings.begin(), readings.end(), from, later);
    for (int64 now = from; now < to; ++next)
    {
        const ImuReading &a = *(next - 1), &b = *next;
        const int64 end = std::min(to, b.nanoseconds);
        if (b.nanoseconds - a.nanoseconds > MAX_GAP)
            return false;
        // readings are linear, so their mean over the step is their value at its middle
        const double share = (.5 * double(now - a.nanoseconds) + .5 * double(end - a.nanoseconds)) /
                             double(b.nanoseconds - a.nanoseconds);
        const double dt = double(end - now) * 1e-9;
        ImuState::Matrix step;
        advance(state, a.rate + share * (b.rate - a.rate), a.force + share * (b.force - a.force), dt, step);
        now = end;
        if (!covariance)
            continue;
        ImuState::Matrix& c = *covariance;
        c = step * c * step.t();
        for (int i = 0; i < ImuState::SIZE; i++)
            c(i, i) += NOISE[i / 3] * dt;
        *change = step * *change;
    }
    return true;
}

Matx66d covarianceAt(const Matx66d& covariance, const Vec3d& offset)
{
    Matx66d change = Matx66d::eye();
    setBlock(change, 0, 3, -crossProduct(offset));
    return change * covariance * change.t();
}

}  // namespace cv::iib
