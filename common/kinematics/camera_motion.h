#pragma once

#include <cstdint>
#include <optional>

#include "common/kinematics/camera_state.h"
#include "common/kinematics/hand_eye.h"
#include "common/kinematics/joint_history.h"
#include "common/kinematics/pose_history.h"

namespace visavis {

/// Where the camera is at any recent time, whatever its motion is known from.
class CameraMotion {
 public:
  virtual ~CameraMotion() = default;

  /// None where the motion is not known at @p utime_us (see JointHistory, PoseHistory).
  virtual std::optional<CameraState> At(std::int64_t utime_us) const = 0;

  /// Time of the newest sample: at or after an exposure, nothing is left to wait for.
  virtual std::optional<std::int64_t> newest_us() const = 0;

  virtual const SampleCounts& counts() const = 0;
};

/// From the joint states of the arm that carries the camera; rotations and velocities through its
/// kinematics (Eqs. 4 and 5).
class ArmCameraMotion final : public CameraMotion {
 public:
  explicit ArmCameraMotion(HandEye hand_eye, const HistoryOptions& options = {});

  /// As JointHistory's.
  SampleVerdict Add(std::int64_t utime_us, const std::vector<std::string>& names,
                    const Eigen::Ref<const Eigen::VectorXd>& q,
                    const Eigen::Ref<const Eigen::VectorXd>& qdot) {
    return joints_.Add(utime_us, names, q, qdot);
  }
  void Clear() { joints_.Clear(); }

  std::optional<CameraState> At(std::int64_t utime_us) const override;
  std::optional<std::int64_t> newest_us() const override { return joints_.newest_us(); }
  const SampleCounts& counts() const override { return joints_.counts(); }

  const HandEye& hand_eye() const { return hand_eye_; }
  const JointHistory& joints() const { return joints_; }

 private:
  HandEye hand_eye_;
  JointHistory joints_;
};

/// From poses of the camera in the world (CAMERA_POSE).
class PoseCameraMotion final : public CameraMotion {
 public:
  explicit PoseCameraMotion(const HistoryOptions& options = PoseHistory::kDefaults)
      : poses_(options) {}

  /// As PoseHistory's.
  SampleVerdict Add(std::int64_t utime_us, const RigidTransform& X_WC) {
    return poses_.Add(utime_us, X_WC);
  }
  void Clear() { poses_.Clear(); }

  std::optional<CameraState> At(std::int64_t utime_us) const override {
    return poses_.At(utime_us);
  }
  std::optional<std::int64_t> newest_us() const override { return poses_.newest_us(); }
  const SampleCounts& counts() const override { return poses_.counts(); }

  const PoseHistory& poses() const { return poses_; }

 private:
  PoseHistory poses_;
};

}  // namespace visavis
