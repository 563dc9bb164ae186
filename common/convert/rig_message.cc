#include "common/convert/rig_message.h"

#include <algorithm>

#include "common/convert/message_error.h"
#include "common/convert/pose_message.h"

namespace visavis {
namespace {

Pinhole FromMessage(const camera_intrinsics_t& m) {
  Pinhole camera{m.width, m.height, m.fx_px, m.fy_px, m.cx_px, m.cy_px, {}};
  std::copy(m.distortion, m.distortion + 5, camera.distortion.begin());
  return camera;
}

camera_intrinsics_t ToMessage(const Pinhole& camera) {
  camera_intrinsics_t m{};
  m.width = camera.width;
  m.height = camera.height;
  m.fx_px = camera.fx;
  m.fy_px = camera.fy;
  m.cx_px = camera.cx;
  m.cy_px = camera.cy;
  std::copy(camera.distortion.begin(), camera.distortion.end(), m.distortion);
  return m;
}

void WriteTransform(const RigidTransform& X, double p_m[3], double q_wxyz[4]) {
  Eigen::Map<Eigen::Vector3d>(p_m, 3) = X.translation();
  WriteQuaternion(X.linear(), q_wxyz);
}

}  // namespace

RigDescription FromMessage(const stereo_rig_t& message) {
  RequireField(message.utime >= 0, "stereo_rig_t.utime", message.utime, "must be >= 0");
  RigDescription description;
  description.rig = {FromMessage(message.right), FromMessage(message.left),
                     ReadTransform("stereo_rig_t.X_CL", message.p_CL_m, message.q_CL_wxyz)};
  if (message.has_hand_eye) {
    description.X_HC = ReadTransform("stereo_rig_t.X_HC", message.p_HC_m, message.q_HC_wxyz);
  }
  if (!message.arm_urdf.empty()) {
    description.arm =
        ArmDescription{message.arm_urdf, message.arm_base_link, message.arm_tip_link,
                       ReadTransform("stereo_rig_t.X_WB", message.p_WB_m, message.q_WB_wxyz)};
  }
  try {
    description.ValidateOrThrow();
  } catch (const std::invalid_argument& e) {
    throw MessageError(std::string("stereo_rig_t: ") + e.what());
  }
  return description;
}

stereo_rig_t ToMessage(const RigDescription& description, std::int64_t utime) {
  stereo_rig_t message{};
  message.utime = utime;
  message.right = ToMessage(description.rig.right);
  message.left = ToMessage(description.rig.left);
  WriteTransform(description.rig.X_CL, message.p_CL_m, message.q_CL_wxyz);
  message.has_hand_eye = description.X_HC.has_value();
  WriteTransform(description.X_HC.value_or(RigidTransform::Identity()), message.p_HC_m,
                 message.q_HC_wxyz);
  const ArmDescription arm = description.arm.value_or(ArmDescription{});
  message.arm_urdf = arm.urdf;
  message.arm_base_link = arm.base_link;
  message.arm_tip_link = arm.tip_link;
  WriteTransform(arm.X_WB, message.p_WB_m, message.q_WB_wxyz);
  return message;
}

}  // namespace visavis
