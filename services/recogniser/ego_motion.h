#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/kinematics/camera_motion.h"
#include "common/rigs/rig_description.h"
#include "services/recogniser/estimator.h"

namespace visavis {

enum class EgoMotionSource { kNone, kArm, kCameraPose };

/// The camera's own motion from the arm or from camera poses, and the step between two exposures.
class EgoMotion {
 public:
  enum class Choice { kAuto, kArm, kCameraPose, kNone };

  explicit EgoMotion(Choice choice) : choice_(choice) {}

  /// "auto", "arm", "camera_pose", "none". @throws std::invalid_argument for another word.
  static Choice ParseChoice(const std::string& word);

  /// Takes over the arm of a rig, or none. @throws std::invalid_argument naming what is wrong with
  /// the arm; then nothing is changed.
  void SetRig(const RigDescription& rig);

  /// @return why the state was not taken; empty: taken, or there is no arm to take it.
  std::string AddArmState(std::int64_t utime_us, const std::vector<std::string>& names,
                          const std::vector<double>& q, const std::vector<double>& qdot);
  std::string AddCameraPose(std::int64_t utime_us, const RigidTransform& X_WC);

  /// Forgets the samples of each source that reaches beyond @p utime_us: they are of an earlier
  /// session. A source whose new session has begun keeps its samples.
  void ForgetSamplesAfter(std::int64_t utime_us);

  /// The source in use: what was chosen, or for kAuto what has come.
  EgoMotionSource source() const;
  /// Whether motion is wanted but no source has given any: feedforward is missing.
  bool missing() const;

  /// The camera at an exposure; nothing where it is not known.
  std::optional<CameraState> At(std::int64_t utime_us) const;
  /// Whether a sample at or after the exposure is there, or none is to be waited for.
  bool IsCertainAt(std::int64_t utime_us) const;

  /// From the exposure at @p utime_1_us to that at @p utime_2_us.
  CameraStep Between(std::int64_t utime_1_us, std::int64_t utime_2_us) const;

 private:
  const CameraMotion* motion() const;

  Choice choice_;
  bool rig_has_arm_{false};
  std::unique_ptr<ArmCameraMotion> arm_;
  PoseCameraMotion poses_;
};

}  // namespace visavis
