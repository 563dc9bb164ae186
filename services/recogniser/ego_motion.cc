#include "services/recogniser/ego_motion.h"

#include <stdexcept>
#include <utility>

namespace visavis {

EgoMotion::Choice EgoMotion::ParseChoice(const std::string& word) {
  if (word == "auto") return Choice::kAuto;
  if (word == "arm") return Choice::kArm;
  if (word == "camera_pose") return Choice::kCameraPose;
  if (word == "none") return Choice::kNone;
  throw std::invalid_argument("ego_motion: " + word + ": must be auto, arm, camera_pose or none");
}

void EgoMotion::SetRig(const RigDescription& rig) {
  std::unique_ptr<ArmCameraMotion> arm;
  if (rig.arm) {
    arm = std::make_unique<ArmCameraMotion>(
        HandEye(Arm(rig.arm->urdf, rig.arm->base_link, rig.arm->tip_link), rig.arm->X_WB,
                rig.X_HC.value_or(RigidTransform::Identity())));
  }
  arm_ = std::move(arm);
  rig_has_arm_ = rig.arm.has_value();
}

std::string EgoMotion::AddArmState(std::int64_t utime_us, const std::vector<std::string>& names,
                                   const std::vector<double>& q, const std::vector<double>& qdot) {
  if (!arm_) return "";
  const auto as_vector = [](const std::vector<double>& v) {
    return Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
  };
  const auto verdict = arm_->Add(utime_us, names, as_vector(q), as_vector(qdot));
  return verdict == SampleVerdict::kAccepted ? "" : arm_->joints().DescribeLastRejection();
}

std::string EgoMotion::AddCameraPose(std::int64_t utime_us, const RigidTransform& X_WC) {
  const auto verdict = poses_.Add(utime_us, X_WC);
  return verdict == SampleVerdict::kAccepted ? "" : poses_.poses().DescribeLastRejection();
}

void EgoMotion::ForgetSamplesAfter(std::int64_t utime_us) {
  if (arm_ && arm_->newest_us() > utime_us) arm_->Clear();
  if (poses_.newest_us() > utime_us) poses_.Clear();
}

EgoMotionSource EgoMotion::source() const {
  const bool arm_came = arm_ && arm_->newest_us(), poses_came = poses_.newest_us().has_value();
  switch (choice_) {
    case Choice::kNone:
      return EgoMotionSource::kNone;
    case Choice::kArm:
      return EgoMotionSource::kArm;
    case Choice::kCameraPose:
      return EgoMotionSource::kCameraPose;
    case Choice::kAuto:
      break;
  }
  if (arm_came) return EgoMotionSource::kArm;
  if (poses_came) return EgoMotionSource::kCameraPose;
  return rig_has_arm_ ? EgoMotionSource::kArm : EgoMotionSource::kNone;
}

bool EgoMotion::missing() const {
  const CameraMotion* used = motion();
  return source() != EgoMotionSource::kNone && (!used || !used->newest_us());
}

const CameraMotion* EgoMotion::motion() const {
  switch (source()) {
    case EgoMotionSource::kArm:
      return arm_.get();
    case EgoMotionSource::kCameraPose:
      return &poses_;
    case EgoMotionSource::kNone:
      break;
  }
  return nullptr;
}

std::optional<CameraState> EgoMotion::At(std::int64_t utime_us) const {
  const CameraMotion* used = motion();
  return used ? used->At(utime_us) : std::nullopt;
}

bool EgoMotion::IsCertainAt(std::int64_t utime_us) const {
  const CameraMotion* used = motion();
  if (!used) return true;
  const auto newest = used->newest_us();
  return !newest || *newest >= utime_us;  // where nothing comes there is nothing to wait for
}

CameraStep EgoMotion::Between(std::int64_t utime_1_us, std::int64_t utime_2_us) const {
  CameraStep step;
  if (utime_2_us <= utime_1_us) return step;
  const auto camera_1 = At(utime_1_us), camera_2 = At(utime_2_us);
  if (!camera_1 || !camera_2) return step;
  step.known = true;
  step.dt_s = 1e-6 * static_cast<double>(utime_2_us - utime_1_us);
  step.X_C2C1 = CameraDisplacement(camera_1->X_WC, camera_2->X_WC);
  step.X_WC1 = camera_1->X_WC;
  // Camera poses carry no velocity of their own: there the twist between the two poses stands in.
  step.twist_1 = source() == EgoMotionSource::kArm
                     ? camera_1->twist
                     : TwistBetween(camera_1->X_WC, camera_2->X_WC, step.dt_s);
  return step;
}

}  // namespace visavis
