#include "services/simulator/arm_trajectory.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace visavis {
namespace {

constexpr double kKnotS = 0.02;
constexpr std::size_t kMaxKnots = 200;

}  // namespace

ArmTrajectory::ArmTrajectory(const HandEye& hand_eye, const Eigen::VectorXd& q_preferred,
                             std::function<RigidTransform(double)> camera_path)
    : hand_eye_(hand_eye),
      solver_(hand_eye.arm(), q_preferred),
      camera_path_(std::move(camera_path)),
      q_start_(q_preferred) {}

const JointVector& ArmTrajectory::Knot(std::int64_t index) {
  while (first_knot_ + static_cast<std::int64_t>(knots_.size()) <= index) {
    const double time_s =
        kKnotS * static_cast<double>(first_knot_ + static_cast<std::int64_t>(knots_.size()));
    const Eigen::VectorXd start = knots_.empty() ? q_start_ : Eigen::VectorXd(knots_.back());
    const auto solution = solver_.Solve(hand_eye_.HandPoseFor(camera_path_(time_s)), start);
    if (!solution.ok()) {
      throw std::runtime_error("the arm cannot follow the scenario at " + std::to_string(time_s) +
                               " s: " + solution.problem);
    }
    knots_.push_back(solution.q);
    if (knots_.size() > kMaxKnots) {
      knots_.pop_front();
      ++first_knot_;
    }
  }
  return knots_.at(static_cast<std::size_t>(index - first_knot_));
}

ArmTrajectory::Sample ArmTrajectory::At(double time_s) {
  const auto index = static_cast<std::int64_t>(std::floor(time_s / kKnotS));
  const double s = time_s / kKnotS - static_cast<double>(index);
  // The shutter may open before the start; a path of the arm has no beginning.
  if (first_knot_ == kNone) first_knot_ = index - 2;
  const JointVector q3 = Knot(index + 2);  // first: it may drop knots at the front
  const JointVector q0 = Knot(index - 1), q1 = Knot(index), q2 = Knot(index + 1);
  // Hermite with the knots' central differences as velocities (Catmull-Rom).
  const JointVector m1 = (q2 - q0) / 2, m2 = (q3 - q1) / 2;
  const double s2 = s * s, s3 = s2 * s;
  Sample sample;
  sample.q = (2 * s3 - 3 * s2 + 1) * q1 + (s3 - 2 * s2 + s) * m1 + (-2 * s3 + 3 * s2) * q2 +
             (s3 - s2) * m2;
  sample.qdot =
      ((6 * s2 - 6 * s) * (q1 - q2) + (3 * s2 - 4 * s + 1) * m1 + (3 * s2 - 2 * s) * m2) / kKnotS;
  return sample;
}

}  // namespace visavis
