// SPDX-License-Identifier: Apache-2.0

#include "smoother.hpp"

#include <deque>

#include <ceres/normal_prior.h>

#include "bundle.hpp"
#include "residuals.hpp"

namespace iib_localization {
namespace {

constexpr size_t LAG = 10;                   // frames
constexpr size_t FIRST_FRAMES = 8;           // with poses, that the start is found from
constexpr size_t MAX_POINTS = 100;           // a frame
constexpr int64_t MAX_ALONE = int64_t(3e9);  // nanoseconds without an image
constexpr double GRAVITY = 9.81;             // m/s^2
constexpr double GRAVITY_DEVIATION = 0.2;    // m/s^2, of the first guess across its direction

typedef Eigen::Matrix<double, 9, 1> Motion;

struct State
{
    const VisualFrame* frame;
    Pose pose;
    Motion motion = Motion::Zero();

    Eigen::Vector3d velocity() const { return motion.head<3>(); }
    ImuBias bias() const { return {motion.segment<3>(3), motion.tail<3>()}; }
};

State predict(const State& from, const Preintegration& p, const Eigen::Vector3d& gravity)
{
    State to = from;
    to.pose.rotation = (from.pose.rotation * p.rotation).normalized();
    to.pose.position += from.velocity() * p.seconds + gravity * (p.seconds * p.seconds / 2) +
                        from.pose.rotation * p.position;
    to.motion.head<3>() += gravity * p.seconds + from.pose.rotation * p.velocity;
    return to;
}

/** Gravity and the first velocity, by linear least squares: rotations are known, and positions and velocities are linear
in both (the equations of ImuError without biases). */
bool findStart(const std::vector<const VisualFrame*>& frames, const std::vector<ImuReading>& readings,
        Eigen::Vector3d& gravity, Eigen::Vector3d& velocity)
{
    const Eigen::Index n = Eigen::Index(frames.size());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(6 * (n - 1), 3 * n + 3);
    Eigen::VectorXd b(6 * (n - 1));
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    for (Eigen::Index i = 0; i + 1 < n; i++)
    {
        Preintegration p;
        if (!preintegrate(readings, frames[i]->nanoseconds, frames[i + 1]->nanoseconds, {}, p))
            return false;
        const Pose &from = *frames[i]->pose, &to = *frames[i + 1]->pose;
        a.block<3, 3>(6 * i, 3 * i) = one * p.seconds;
        a.block<3, 3>(6 * i, 3 * n) = one * (p.seconds * p.seconds / 2);
        b.segment<3>(6 * i) = to.position - from.position - from.rotation * p.position;
        a.block<3, 3>(6 * i + 3, 3 * i) = -one;
        a.block<3, 3>(6 * i + 3, 3 * i + 3) = one;
        a.block<3, 3>(6 * i + 3, 3 * n) = -one * p.seconds;
        b.segment<3>(6 * i + 3) = from.rotation * p.velocity;
    }
    const Eigen::VectorXd x = a.colPivHouseholderQr().solve(b);
    velocity = x.head<3>();
    gravity = x.tail<3>();
    // far from what it should be, the poses are wrong, or the IMU has other axes
    if (std::abs(gravity.norm() - GRAVITY) > 2)
        return false;
    gravity *= GRAVITY / gravity.norm();
    return true;
}

class FixedLag
{
public:
    FixedLag(const Pinhole& camera, const std::vector<ImuReading>& readings, const State& first,
            const Eigen::Vector3d& gravity)
        : camera_(camera), readings_(readings), gravity_(gravity), firstGravity_(gravity), states_{first}
    {
        Eigen::Matrix<double, 15, 1> deviations;
        deviations << Eigen::Vector3d::Constant(1), Eigen::Vector3d::Constant(0.2),
                Eigen::Vector3d::Constant(1), Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.2);
        setPrior(first, deviations.array().square().matrix().asDiagonal());
    }

    //! False if the readings do not reach.
    bool add(const VisualFrame& frame)
    {
        Preintegration p;
        if (!preintegrate(readings_, states_.back().frame->nanoseconds, frame.nanoseconds,
                    states_.back().bias(), p))
            return false;
        State state = predict(states_.back(), p, gravity_);
        state.frame = &frame;
        if (frame.pose)
            state.pose = *frame.pose;
        states_.push_back(state);
        between_.push_back(p);
        solve();
        return true;
    }

    bool full() const { return states_.size() > LAG; }
    bool empty() const { return states_.empty(); }

    //! Takes the oldest state out and leaves what it told as a prior of the next.
    State pop()
    {
        const State oldest = states_.front();
        if (states_.size() > 1)
            marginalize();
        states_.pop_front();
        if (!between_.empty())
            between_.pop_front();
        return oldest;
    }

private:
    void addState(ceres::Problem& problem, State& state, bool points)
    {
        double* rotation = state.pose.rotation.coeffs().data();
        problem.AddParameterBlock(rotation, 4, new ceres::EigenQuaternionManifold);
        const std::vector<Observation>& all = state.frame->inliers;
        const size_t step = all.size() / MAX_POINTS + 1;
        for (size_t i = 0; points && state.frame->pose && i < all.size(); i += step)
        {
            double* point = const_cast<double*>(all[i].point.data());  // constant, see below
            problem.AddResidualBlock(ReprojectionError::create(camera_, all[i].pixel),
                    new ceres::ScaledLoss(new ceres::CauchyLoss(1), POINT_WEIGHT, ceres::TAKE_OWNERSHIP),
                    rotation, state.pose.position.data(), point);
            problem.SetParameterBlockConstant(point);
        }
    }

    void addImu(ceres::Problem& problem, State& a, State& b, const Preintegration& p)
    {
        problem.AddResidualBlock(ImuError::create(p), nullptr, a.pose.rotation.coeffs().data(),
                a.pose.position.data(), a.motion.data(), b.pose.rotation.coeffs().data(),
                b.pose.position.data(), b.motion.data(), gravity_.data());
    }

    void addPrior(ceres::Problem& problem, State& state)
    {
        problem.AddResidualBlock(StatePrior::create(priorPose_, priorMotion_, priorCovariance_), nullptr,
                state.pose.rotation.coeffs().data(), state.pose.position.data(), state.motion.data());
    }

    void setPrior(const State& state, const Matrix15& covariance)
    {
        priorPose_ = state.pose;
        priorMotion_ = state.motion;
        priorCovariance_ = covariance;
    }

    static void run(ceres::Problem& problem)
    {
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
        options.max_num_iterations = 15;
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
    }

    void solve()
    {
        ceres::Problem problem;
        for (State& state : states_)
            addState(problem, state, true);
        addPrior(problem, states_.front());
        for (size_t i = 0; i < between_.size(); i++)
            addImu(problem, states_[i], states_[i + 1], between_[i]);
        problem.SetManifold(gravity_.data(), new ceres::SphereManifold<3>);
        problem.AddResidualBlock(
                new ceres::NormalPrior(Eigen::Matrix3d::Identity() / GRAVITY_DEVIATION, firstGravity_),
                nullptr, gravity_.data());
        run(problem);
    }

    //! All factors of the oldest state and the next state alone: the covariance of the next is what they tell of it.
    void marginalize()
    {
        State a = states_[0], b = states_[1];
        ceres::Problem problem;
        addState(problem, a, true);
        addState(problem, b, false);
        addPrior(problem, a);
        addImu(problem, a, b, between_[0]);
        problem.SetParameterBlockConstant(gravity_.data());
        run(problem);
        ceres::Covariance::Options options;
        options.algorithm_type = ceres::DENSE_SVD;
        options.min_reciprocal_condition_number = 1e-20;  // units differ
        ceres::Covariance covariance(options);
        const std::vector<const double*> blocks = {
                b.pose.position.data(), b.pose.rotation.coeffs().data(), b.motion.data()};
        Eigen::Matrix<double, 15, 15, Eigen::RowMajor> c;
        if (!covariance.Compute(blocks, &problem) ||
                !covariance.GetCovarianceMatrixInTangentSpace(blocks, c.data()))
            c = priorCovariance_;  // never seen; no surer than the state before
        else
        {
            // Ceres' tangent of a quaternion is half the angle.
            c.middleRows<3>(3) *= 2;
            c.middleCols<3>(3) *= 2;
        }
        setPrior(b, c);
    }

    const Pinhole camera_;
    const std::vector<ImuReading>& readings_;
    Eigen::Vector3d gravity_;
    const Eigen::Vector3d firstGravity_;
    std::deque<State> states_;  // a deque does not move what is in it
    std::deque<Preintegration> between_;
    Pose priorPose_;
    Motion priorMotion_;
    Matrix15 priorCovariance_;
};

//! Smooths frames from `first` on, which has a pose, and returns where it had to stop.
size_t smoothRun(const Pinhole& camera, const std::vector<VisualFrame>& frames,
        const std::vector<ImuReading>& readings, size_t first, std::vector<std::optional<Pose>>& poses)
{
    std::vector<const VisualFrame*> start;
    for (size_t i = first; i < frames.size() && start.size() < FIRST_FRAMES; i++)
        if (frames[i].pose)
            start.push_back(&frames[i]);
    State state;
    state.frame = &frames[first];
    state.pose = *frames[first].pose;
    Eigen::Vector3d gravity, velocity;
    poses[first] = state.pose;
    if (start.size() < 4 || !findStart(start, readings, gravity, velocity))
        return first + 1;
    state.motion.head<3>() = velocity;
    FixedLag window(camera, readings, state, gravity);
    const auto pop = [&] {
        const State oldest = window.pop();
        poses[size_t(oldest.frame - frames.data())] = oldest.pose;
    };
    size_t next = first + 1;
    int64_t seen = frames[first].nanoseconds;
    for (; next < frames.size() && frames[next].nanoseconds - seen <= MAX_ALONE && window.add(frames[next]);
            next++)
    {
        if (frames[next].pose)
            seen = frames[next].nanoseconds;
        if (window.full())
            pop();
    }
    while (!window.empty())
        pop();
    return next;
}

}  // namespace

std::vector<std::optional<Pose>> smooth(const Pinhole& camera, const std::vector<VisualFrame>& frames,
        const std::vector<ImuReading>& readings)
{
    std::vector<std::optional<Pose>> poses(frames.size());
    for (size_t i = 0; i < frames.size();)
        i = frames[i].pose ? smoothRun(camera, frames, readings, i, poses) : i + 1;
    return poses;
}

}  // namespace iib_localization
