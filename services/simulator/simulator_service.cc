#include "services/simulator/simulator_service.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/convert/image_message.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "common/image/gray.h"
#include "common/rigs/demo_rig.h"
#include "common/rigs/rig_file.h"
#include "services/simulator/mesh_export.h"

namespace visavis {
namespace {

// A simulated log begins here in message time, so that the same scenario has the same bytes.
constexpr std::int64_t kFastStartUs = 1'000'000'000'000'000;

// A head of which less is in the right picture counts as away.
constexpr double kSeenShare = 0.1;

RigDescription LoadRig(const std::string& file) {
  RigDescription rig = file.empty() ? DemoRig() : LoadRigFile(file);
  if (!rig.arm || !rig.X_HC)
    throw std::invalid_argument("rig_file: " + file + ": must have an arm and X_HC");
  return rig;
}

HandEye MakeHandEye(const RigDescription& rig) {
  return {Arm(rig.arm->urdf, rig.arm->base_link, rig.arm->tip_link), rig.arm->X_WB, *rig.X_HC};
}

RgbView View(const Pinhole& eye, std::vector<std::uint8_t>* pixels) {
  return {pixels->data(), eye.width, eye.height, 3 * eye.width};
}

Eigen::VectorXd Posture() {
  return Eigen::Map<const Eigen::VectorXd>(kDemoArmPosture.data(),
                                           static_cast<Eigen::Index>(kDemoArmPosture.size()));
}

}  // namespace

ServiceTraits SimulatorService::Traits() {
  ServiceTraits traits;
  traits.name = "simulator";
  traits.description = "Renders a head before two cameras on an arm, with exact truth";
  traits.runs_fast = true;
  traits.aliases = {
      {"--scenario", "scenario.name", "shuttle_x, orbit_theta, static, moving_head, random_poses"},
      {"--period", "scenario.period_s", "[s] of shuttle_x and orbit_theta"},
      {"--subject", "scene.subject", "who stands before the cameras, adult_a ..."},
      {"--seconds", "seconds", "how long; 0: until stopped"},
      {"--seed", "seed", "of all that is random"},
      {"--export-mesh", "export_mesh",
       "FILE: writes the subject's head there as OBJ; ends then, unless --seconds"}};
  return traits;
}

SimulatorService::SimulatorService(const SimulatorConfig& config, const ServiceContext& context)
    : config_(config),
      context_(context),
      rig_(LoadRig(config.rig_file)),
      X_WS_(DemoCameraPose()),
      hand_eye_(MakeHandEye(rig_)),
      world_(config.scenario, config.scene, config.sensor, rig_.rig, X_WS_,
             static_cast<std::uint64_t>(config.seed)),
      trajectory_(hand_eye_, Posture(),
                  [this](double time_s) { return world_.scenario().CameraPose(time_s); }),
      start_us_(context.live ? context.clock->NowUs() + 100'000 : kFastStartUs),
      next_rig_us_(start_us_) {
  if (!config_.export_rig.empty()) SaveRigFile(rig_, config_.export_rig);
  if (!config_.export_mesh.empty()) ExportHead(world_.figure(), config_.export_mesh);
  rig_message_ = ToMessage(rig_, 0);
  if (!config_.publish_arm) {
    rig_message_.has_hand_eye = false;
    rig_message_.arm_urdf.clear();
  }
  arm_state_ = arm_state_t{};
  for (const ArmJoint& joint : hand_eye_.arm().joints())
    arm_state_.joint_names.push_back(joint.name);
  arm_state_.num_joints = static_cast<std::int32_t>(arm_state_.joint_names.size());
  arm_state_.source = "simulator";
  arm_state_.clock_state = arm_state_t::CLOCK_SYNCHRONISED;
  arm_state_.clock_offset_s = 0;
  images_.n_images = 2;
  images_.image_types = {images_t::LEFT, images_t::RIGHT};
  images_.images.resize(2);
  if (config_.cameras == "gige") {
    if (!context_.live) throw std::invalid_argument("cameras: gige: must be publish with --fast");
    cameras_ = std::make_unique<GigeCameras>(config_.gige, rig_.rig, config_.frame_rate_hz,
                                             config_.sensor.exposure_ms);
    tick_us_ = start_us_;
    TimeFrame();
    start_us_ = frame_us_;  // the first exposure, as it is without cameras
  } else {
    picture_ = std::make_shared<StereoPicture>(rig_.rig);
    TimeFrame();
  }
}

SimulatorService::~SimulatorService() = default;

std::int64_t SimulatorService::FrameTime(std::int64_t frame) const {
  return start_us_ + std::llround(1e6 * static_cast<double>(frame) / config_.frame_rate_hz);
}

std::int64_t SimulatorService::ArmTime(std::int64_t sample) const {
  return start_us_ + std::llround(1e6 * static_cast<double>(sample) / config_.arm_rate_hz);
}

void SimulatorService::TimeFrame() {
  if (cameras_) {
    tick_us_ = cameras_->NextTick(tick_us_);
    frame_us_ = tick_us_ - cameras_->exposure_us() / 2;
    due_us_ = tick_us_ - cameras_->longest_ahead_us();
  } else {
    frame_us_ = FrameTime(frame_);
    due_us_ = frame_us_ + std::llround(1000 * config_.readout_ms);
  }
}

void SimulatorService::SkipLateFrames() {
  // Cameras do not wait: a picture must be there at its tick.
  while (cameras_ ? tick_us_ < context_.clock->NowUs() + render_us_
                  : FrameTime(frame_ + 1) < context_.clock->NowUs()) {
    ++frame_;
    TimeFrame();
    ++late_;
    context_.status->Dropped(1);
  }
}

std::int64_t SimulatorService::next_wake_us() const {
  if (context_.live && !prepared_) return 0;
  return config_.publish_arm ? std::min(ArmTime(next_arm_), due_us_) : due_us_;
}

bool SimulatorService::finished() const {
  if (config_.seconds == 0) return !config_.export_mesh.empty();
  return TimeOf(frame_us_) >= config_.seconds;
}

void SimulatorService::Wake() {
  if (finished()) return;
  if (cameras_) cameras_->Update(TimeOf(context_.clock->NowUs()));
  PublishRig(context_.clock->NowUs());
  PublishArmStates(context_.clock->NowUs());
  // Live, rendering takes longer than the readout: it is done ahead.
  if (!prepared_ && (context_.live || context_.clock->NowUs() >= due_us_)) PrepareFrame();
  if (context_.clock->NowUs() >= due_us_) PublishFrame();
}

void SimulatorService::UpdateStatus() {
  context_.status->SetCounter("late_pairs", late_);
  if (!cameras_) return;
  context_.status->SetCounter("lost_frames", cameras_->num_lost());
  context_.status->SetCondition("faults", cameras_->Faults());
}

RigidTransform SimulatorService::CameraAt(double time_s) {
  return hand_eye_.CameraPose(trajectory_.At(time_s).q);
}

void SimulatorService::PublishRig(std::int64_t now_us) {
  if (cameras_ || now_us < next_rig_us_) return;
  next_rig_us_ = std::max(next_rig_us_ + 1'000'000, now_us);
  rig_message_.utime = now_us;
  context_.bus->Publish(kStereoRigChannel, rig_message_);
}

void SimulatorService::PublishArmStates(std::int64_t until_us) {
  if (!config_.publish_arm) return;
  for (;; ++next_arm_) {
    const std::int64_t utime_us = ArmTime(next_arm_);
    if (utime_us > until_us) return;
    const auto sample = trajectory_.At(TimeOf(utime_us));
    arm_state_.utime = utime_us;
    arm_state_.seq = next_arm_;
    arm_state_.joint_position.assign(sample.q.data(), sample.q.data() + sample.q.size());
    arm_state_.joint_velocity.assign(sample.qdot.data(), sample.qdot.data() + sample.qdot.size());
    context_.bus->Publish(config_.arm_channel, arm_state_);
  }
}

void SimulatorService::PrepareFrame() {
  if (context_.live) SkipLateFrames();
  if (cameras_) picture_ = cameras_->Blank();
  const std::int64_t begin_us = context_.clock->NowUs();
  const auto truth = world_.Render(
      TimeOf(frame_us_), frame_, [this](double time_s) { return CameraAt(time_s); },
      View(rig_.rig.right, &picture_->right), View(rig_.rig.left, &picture_->left));
  camera_X_WC_ = truth.X_WC;
  truth_X_CM_.reset();
  if (truth.head_present && truth.head_visible_share >= kSeenShare) truth_X_CM_ = truth.X_CM;
  picture_->exposed_us = frame_us_;
  picture_->due_us = tick_us_;
  render_us_ = context_.clock->NowUs() - begin_us;
  if (cameras_) {
    cameras_->Show(std::move(picture_));
  } else {
    FillImages();
  }
  prepared_ = true;
}

void SimulatorService::FillImages() {
  images_.utime = frame_us_;
  FillImage(rig_.rig.left, picture_->left, &left_jpeg_, &images_.images[0]);
  FillImage(rig_.rig.right, picture_->right, &right_jpeg_, &images_.images[1]);
}

void SimulatorService::FillImage(const Pinhole& camera, const std::vector<std::uint8_t>& rgb,
                                 JpegEncoder* jpeg, image_t* image) {
  const ImageView picture{rgb.data(),       camera.width, camera.height,
                          3 * camera.width, rgb.size(),   PixelFormat::kRgb};
  if (config_.image_format == "jpeg") {
    SetImage(jpeg->Encode(picture, config_.jpeg_quality), images_.utime, image);
  } else {
    SetImage(config_.image_format == "gray" ? ToGray(picture, &gray_) : picture, images_.utime,
             image);
  }
  AddMetadata("seq", frame_, image);
  AddMetadata("exposure_us", std::llround(1000 * config_.sensor.exposure_ms), image);
  AddMetadata("skew_us", 0, image);
}

void SimulatorService::PublishFrame() {
  PublishArmStates(context_.clock->NowUs());
  if (config_.publish_camera_pose)
    context_.bus->Publish(kCameraPoseChannel, ToMessage(camera_X_WC_, frame_us_));
  context_.bus->Publish(kHeadPoseTruthChannel,
                        TruthMessage(frame_us_, frame_, truth_X_CM_ ? &*truth_X_CM_ : nullptr));
  if (!cameras_) context_.bus->Publish(kStereoImagesChannel, images_);
  context_.status->Processed(
      cameras_ ? std::nan("") : 1e-3 * static_cast<double>(context_.clock->NowUs() - frame_us_));
  ++frame_;
  TimeFrame();
  prepared_ = false;
}

}  // namespace visavis
