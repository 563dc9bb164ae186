#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/image/image_decoder.h"
#include "common/rigs/rig_description.h"
#include "common/service/service.h"
#include "common/service/service_flags.h"
#include "services/simulator/arm_trajectory.h"
#include "services/simulator/gige_cameras.h"
#include "services/simulator/simulator_config.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/images_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {

/// Publishes what capture, arm state and a measuring arm round the head would: STEREO_IMAGES,
/// STEREO_RIG, ARM_STATE and HEAD_POSE_TRUTH.
///
/// A pair is rendered ahead of its exposure, since the motion is known; then it goes out readout_ms
/// after the exposure, behind the arm states of that time, as it would from real cameras. Truth is
/// NaN while less than a tenth of the head is in the right picture.
///
/// With cameras: gige the pictures leave as frames of two GigE Vision cameras, at these cameras'
/// ticks, rendered and shown to them (and their truth published) up to two periods ahead, so that
/// a rendering that takes longer once makes none late; and whoever captures them publishes
/// STEREO_IMAGES and STEREO_RIG. Truth and arm states carry the host's time as before; the captured
/// pair's differs from its truth's by what the capture's map of the cameras' clocks is wrong.
class SimulatorService final : public Service {
 public:
  static ServiceTraits Traits();

  /// @throws std::invalid_argument for a rig without an arm, and for cameras: gige unless live;
  /// std::runtime_error where a camera's address cannot be had.
  SimulatorService(const SimulatorConfig& config, const ServiceContext& context);
  ~SimulatorService() override;

  std::int64_t next_wake_us() const override;
  void Wake() override;
  bool finished() const override;
  void UpdateStatus() override;

 private:
  double TimeOf(std::int64_t utime_us) const {
    return 1e-6 * static_cast<double>(utime_us - start_us_);
  }
  std::int64_t FrameTime(std::int64_t frame) const;
  std::int64_t ArmTime(std::int64_t sample) const;
  /// Sets the times of the pair @p frame_, which is now in work.
  void TimeFrame();
  /// A machine too slow for the rate leaves pairs out, as a camera would.
  void SkipLateFrames();
  RigidTransform CameraAt(double time_s);
  void PublishArmStates(std::int64_t until_us);
  void PublishRig(std::int64_t now_us);
  void PrepareFrame();
  void FillImages();
  void PublishFrame();
  void FillImage(const Pinhole& camera, const std::vector<std::uint8_t>& rgb, JpegEncoder* jpeg,
                 image_t* image);

  const SimulatorConfig config_;
  const ServiceContext context_;
  RigDescription rig_;
  RigidTransform X_WS_;
  HandEye hand_eye_;
  SimulatedWorld world_;
  ArmTrajectory trajectory_;
  std::unique_ptr<GigeCameras> cameras_;    // none: pictures go on the bus
  std::shared_ptr<StereoPicture> picture_;  // in work
  JpegEncoder right_jpeg_, left_jpeg_;
  std::vector<std::uint8_t> gray_;

  std::int64_t start_us_;
  std::int64_t frame_{0}, next_arm_{0}, next_rig_us_;
  std::int64_t frame_us_{0}, due_us_{0};    // exposure of the pair in work, and when it goes out
  std::int64_t tick_us_{0}, render_us_{0};  // of the cameras; how long the last rendering took
  std::int64_t late_{0};
  bool prepared_{false};
  std::optional<RigidTransform> truth_X_CM_;  // of the prepared frame; none: no head
  RigidTransform camera_X_WC_;                // of the prepared frame
  images_t images_;
  arm_state_t arm_state_;
  stereo_rig_t rig_message_;
};

}  // namespace visavis
