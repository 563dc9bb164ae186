#include "common/kinematics/camera_motion.h"

#include <utility>

namespace visavis {
namespace {

std::vector<std::string> NamesOf(const Arm& arm) {
  std::vector<std::string> names;
  for (const ArmJoint& joint : arm.joints()) names.push_back(joint.name);
  return names;
}

}  // namespace

ArmCameraMotion::ArmCameraMotion(HandEye hand_eye, const HistoryOptions& options)
    : hand_eye_(std::move(hand_eye)), joints_(NamesOf(hand_eye_.arm()), options) {}

std::optional<CameraState> ArmCameraMotion::At(std::int64_t utime_us) const {
  const auto joints = joints_.At(utime_us);
  if (!joints) return std::nullopt;
  return CameraState{hand_eye_.CameraPose(joints->q),
                     TwistFromJoints(hand_eye_.CameraJacobian(joints->q), joints->qdot), true,
                     joints->extrapolated, joints->age_us};
}

}  // namespace visavis
