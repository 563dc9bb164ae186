#include "services/calibrate_tool/arm_postures.h"

namespace visavis {
namespace {

std::vector<std::string> NamesOf(const Arm& arm) {
  std::vector<std::string> names;
  for (const ArmJoint& joint : arm.joints()) names.push_back(joint.name);
  return names;
}

HistoryOptions WithCapacity(int capacity) {
  HistoryOptions options;
  options.capacity = capacity;
  return options;
}

}  // namespace

ArmPostures::ArmPostures(const ArmDescription& arm, int capacity)
    : arm_(arm.urdf, arm.base_link, arm.tip_link), joints_(NamesOf(arm_), WithCapacity(capacity)) {}

void ArmPostures::Add(const arm_state_t& state) {
  const auto vector = [](const std::vector<double>& v) {
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
  };
  joints_.Add(state.utime, state.joint_names, vector(state.joint_position),
              vector(state.joint_velocity));
}

ArmPostures::Matched ArmPostures::Match(const std::vector<StereoView>& views,
                                        double max_speed) const {
  Matched matched;
  for (const StereoView& view : views) {
    const auto sample = joints_.At(view.utime_us);
    if (!sample) {
      ++matched.num_unknown;
    } else if (sample->qdot.cwiseAbs().maxCoeff() > max_speed) {
      ++matched.num_moving;
    } else {
      matched.views.push_back({view, arm_.ForwardKinematics(sample->q)});
    }
  }
  return matched;
}

}  // namespace visavis
