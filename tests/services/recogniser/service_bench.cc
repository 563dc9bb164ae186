#include "tests/services/recogniser/service_bench.h"

#include <algorithm>

#include "common/convert/rig_message.h"
#include "common/eventlog/event_log.h"
#include "common/image/image_decoder.h"

namespace visavis {

StereoRig TinyRig() {
  const Pinhole camera{64, 48, 80, 80, 31.5, 23.5, {}};
  StereoRig rig{camera, camera, RigidTransform::Identity()};
  rig.X_CL.translation().x() = -0.15;
  return rig;
}

RecogniserConfig EasyConfig() {
  RecogniserConfig config;
  config.estimator = "published";  // a tiny picture is enough for it
  config.ga.individuals = 20;
  config.feedforward = "exact";
  config.ego_motion = "auto";
  config.arm_wait_ms = 15;
  config.population_every = 0;
  config.search.preset = "wide";
  config.published.generations_per_frame = 1;
  TrackMonitorConfig& track = config.published.track;
  track.min_fitness = track.min_site = track.min_color = track.min_feat = -1;
  track.keep_fitness = track.keep_color = track.keep_feat = -1;
  track.border_share = 0;
  track.confirm_frames = 1;
  track.max_step_mm = 1000;
  track.max_step_deg = 180;
  return config;
}

images_t PairOf(const StereoFrame& frame, std::int64_t t_us, bool jpeg) {
  images_t message{};
  message.utime = kBaseUs + t_us;
  JpegEncoder encoder;
  const auto add = [&](const ImageView& view, std::int16_t type) {
    message.image_types.push_back(type);
    message.images.emplace_back();
    SetImage(jpeg ? encoder.Encode(view, 90) : view, message.utime, &message.images.back());
  };
  if (frame.left) add(*frame.left, images_t::LEFT);
  if (frame.right) add(*frame.right, images_t::RIGHT);
  message.n_images = static_cast<std::int32_t>(message.images.size());
  return message;
}

images_t PairAt(std::int64_t t_us, const StereoRig& rig) {
  const auto picture = [](const Pinhole& camera) {
    OwnedImage image = FlatImage(camera.width, camera.height, 170, 180, 200);
    for (int y = camera.height / 3; y < 2 * camera.height / 3; ++y) {
      std::fill_n(image.bytes.begin() + 3 * (y * camera.width + camera.width / 3), camera.width,
                  std::uint8_t{20});
    }
    return image;
  };
  const OwnedImage right = picture(rig.right), left = picture(rig.left);
  return PairOf({0, right.view, left.view}, t_us);
}

arm_state_t ArmAt(std::int64_t t_us, double slide_m, double turn_rad, double slide_m_s,
                  double turn_rad_s) {
  arm_state_t message{};
  message.utime = kBaseUs + t_us;
  message.num_joints = 2;
  message.joint_names = kArmJoints;
  message.joint_position = {slide_m, turn_rad};
  message.joint_velocity = {slide_m_s, turn_rad_s};
  message.source = "test";
  return message;
}

std::int64_t CounterOf(const service_status_t& status, const std::string& name) {
  for (std::size_t i = 0; i < status.counter_names.size(); ++i) {
    if (status.counter_names[i] == name) return status.counters[i];
  }
  return -1;
}

ServiceBench::ServiceBench(const RecogniserConfig& config, const std::string& prefix,
                           std::int64_t clock_offset_us, bool live)
    : offset_us_(kBaseUs + clock_offset_us),
      writer_(folder_ / "out.lcm", EventLogWriter::Mode::kReplace),
      bus_(prefix, &clock_, &writer_),
      status_("recogniser", "test") {
  clock_.Set(offset_us_);
  bus_.set_reject_handler([this](const std::string& channel, const std::string& reason) {
    status_.Rejected(channel + ": " + reason, clock_.NowUs());
  });
  service_ =
      std::make_unique<RecogniserService>(config, ServiceContext{&bus_, &clock_, &status_, live});
}

ServiceBench::~ServiceBench() = default;

void ServiceBench::Dispatch(const LogEvent& event, std::int64_t t_us) {
  while (service_->next_wake_us() <= offset_us_ + t_us) {
    clock_.Set(std::max(clock_.NowUs(), service_->next_wake_us()));
    service_->Wake();
  }
  clock_.Set(std::max(clock_.NowUs(), offset_us_ + t_us));
  try {
    bus_.Dispatch(event);
  } catch (const std::exception& e) {
    status_.Rejected(e.what(), clock_.NowUs());
  }
}

void ServiceBench::SendRig(const RigDescription& rig, std::int64_t t_us) {
  Send("STEREO_RIG", ToMessage(rig, kBaseUs + t_us), t_us);
}

std::vector<LogEvent> ServiceBench::Events() {
  writer_.Flush();
  EventLogReader reader(writer_.path());
  std::vector<LogEvent> events;
  LogEvent event;
  while (reader.Next(&event)) events.push_back(event);
  return events;
}

std::vector<std::uint8_t> ServiceBench::PoseBytes() {
  std::vector<std::uint8_t> bytes;
  for (const LogEvent& event : Events()) {
    if (event.channel != bus_.prefix() + "HEAD_POSE") continue;
    bytes.insert(bytes.end(), event.data.begin(), event.data.end());
  }
  return bytes;
}

service_status_t ServiceBench::Status() {
  service_->UpdateStatus();
  return status_.Make(clock_.NowUs());
}

std::int64_t ServiceBench::next_wake_us() const {
  const std::int64_t wake_us = service_->next_wake_us();
  return wake_us == Service::kNever ? wake_us : wake_us - offset_us_;
}

}  // namespace visavis
