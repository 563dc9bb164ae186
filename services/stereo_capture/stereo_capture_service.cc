#include "services/stereo_capture/stereo_capture_service.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "common/bus/channels.h"
#include "common/convert/rig_message.h"
#include "common/core/clock.h"
#include "common/rigs/rig_file.h"

namespace visavis {
namespace {

constexpr std::size_t kQueueFrames = 8;
constexpr double kStartWaitS = 1.5;  // for the cameras' first words
// With start: require, for a camera to answer, and for one that another program may still hold.
constexpr double kRequireFoundS = 2, kRequireWaitS = 8;
constexpr std::int64_t kRigPeriodUs = 1'000'000;

std::array<std::optional<PictureSize>, 2> RigSizes(const std::optional<RigDescription>& rig) {
  if (!rig) return {};
  return {PictureSize{rig->rig.left.width, rig->rig.left.height},
          PictureSize{rig->rig.right.width, rig->rig.right.height}};
}

std::optional<RigDescription> LoadRig(const std::string& file) {
  if (file.empty()) return std::nullopt;
  return LoadRigFile(file);
}

}  // namespace

ServiceTraits StereoCaptureService::Traits() {
  ServiceTraits traits;
  traits.name = "stereo-capture";
  traits.description = "Publishes pairs of pictures from two cameras, videos or a folder";
  traits.list_help = "print the cameras found and what they support, and exit";
  traits.aliases = {{"--source", "source", "aravis, uvc, folder or video"},
                    {"--left", "left.device", "serial, name, address or file of the left camera"},
                    {"--right", "right.device", "likewise of the right camera"},
                    {"--rig", "rig_file", "rig.yaml to publish with the pictures"}};
  return traits;
}

StereoCaptureService::StereoCaptureService(const StereoCaptureConfig& config,
                                           const ServiceContext& context)
    : config_(config),
      context_(context),
      rig_(LoadRig(config.rig_file)),
      message_(config.image_format == "jpeg" ? std::optional<int>(config.jpeg_quality)
                                             : std::nullopt),
      pairer_(config.tolerance_us()),
      timing_{FrameTiming(config.camera), FrameTiming(config.camera)},
      next_rig_us_(context.clock->NowUs()),
      queue_(kQueueFrames) {
  if (rig_) rig_message_ = ToMessage(*rig_, 0);
  sources_ = MakeSources(config_, RigSizes(rig_), &queue_);
  AwaitCameras();
  last_usable_us_.fill(context.clock->NowUs());
}

StereoCaptureService::~StereoCaptureService() = default;

void StereoCaptureService::AwaitCameras() {
  using State = CameraReport::State;
  const bool require = config_.start == "require";
  const double end_s = MonotonicSeconds() + (require ? kRequireWaitS : kStartWaitS);
  for (;;) {
    bool decided = true;
    for (const auto& source : sources_) {
      const CameraReport report = source->Report();
      if (report.state == State::kRefused) throw std::invalid_argument(report.text);
      const bool told = report.state == State::kStreaming ||
                        (!require && report.state == State::kSearching && report.attempts > 0);
      decided = decided && told;
      const bool missing = report.state == State::kSearching &&
                           MonotonicSeconds() > end_s - kRequireWaitS + kRequireFoundS;
      if (!told && require && (missing || MonotonicSeconds() > end_s))
        throw std::invalid_argument("start: require: " + report.text);
    }
    if (decided || MonotonicSeconds() > end_s) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

std::int64_t StereoCaptureService::next_wake_us() const { return rig_ ? next_rig_us_ : kNever; }

bool StereoCaptureService::finished() const {
  return sources_[0]->finished() && sources_[1]->finished();
}

void StereoCaptureService::Wake() {
  const std::int64_t now_us = context_.clock->NowUs();
  if (now_us < next_rig_us_ - 2 * kRigPeriodUs) next_rig_us_ = now_us;  // the clock was set back
  if (rig_ && now_us >= next_rig_us_) {
    next_rig_us_ = std::max(next_rig_us_ + kRigPeriodUs, now_us);
    rig_message_.utime = now_us;
    context_.bus->Publish(kStereoRigChannel, rig_message_);
  }
  while (auto frame = queue_.Pop()) Take(std::move(*frame));
}

bool StereoCaptureService::IsAway(Side side, std::int64_t now_us) const {
  return static_cast<double>(now_us - last_usable_us_[Index(side)]) >
         1e6 * config_.camera.stall_s();
}

void StereoCaptureService::Take(CapturedFrame frame) {
  const Side side = frame.side;
  FrameTiming& timing = timing_[Index(side)];
  const auto utime_us = timing.Add(frame);
  if (timing.restarted()) pairer_.Clear(side);
  if (!utime_us) return;
  const std::int64_t now_us = context_.clock->NowUs();
  last_usable_us_[Index(side)] = now_us;
  const std::int64_t camera_us = timing.CameraMidUs(frame);
  StampedFrame stamped{std::move(frame), *utime_us, camera_us};
  if (IsAway(Other(side), now_us)) {
    pairer_.Clear(side);
    if (!config_.single_images) return;
    ++num_singles_;
    return Publish(message_.Single(stamped, seq_++));
  }
  const auto pair = pairer_.Add(side, *utime_us, std::move(stamped));
  if (!pair) return;
  ++num_pairs_;
  ++skews_.count;
  skews_.sum_us += std::abs(pair->skew_us());
  skews_.worst_us = std::max(skews_.worst_us, std::abs(pair->skew_us()));
  Publish(message_.Pair(pair->left.frame, pair->right.frame, seq_++));
}

void StereoCaptureService::Publish(const images_t& images) {
  context_.bus->Publish(kStereoImagesChannel, images);
  message_.GiveBack();
  context_.status->Processed(1e-3 * static_cast<double>(context_.clock->NowUs() - images.utime));
}

void StereoCaptureService::UpdateStatus() {
  TellStatusOf(Side::kLeft);
  TellStatusOf(Side::kRight);
  TellStatusOfPairs();
}

void StereoCaptureService::TellStatusOf(Side side) {
  const CameraReport report = sources_[Index(side)]->Report();
  const std::string name = SideName(side);
  StatusReporter& status = *context_.status;
  status.SetCondition(name, report.text);
  if (report.last_error != told_errors_[Index(side)])
    status.Error(told_errors_[Index(side)] = report.last_error, context_.clock->NowUs());
  const auto count = [&](const char* what, std::int64_t value) {
    status.SetCounter(name + "_" + what, value);
  };
  count("frames", report.frames);
  count("bad_frames", report.bad_frames);
  count("missing_packets", report.missing_packets);
  count("resent_packets", report.resent_packets);
  count("connects", report.connects);
  count("stalls", report.stalls);
  count("lost_frames", timing_[Index(side)].lost());
  count("untimed_frames", timing_[Index(side)].untimed());
  count("unpaired_frames", pairer_.unpaired(side));
  count("drift_ppb", std::llround(1e3 * timing_[Index(side)].drift_ppm()));
}

void StereoCaptureService::TellStatusOfPairs() {
  StatusReporter& status = *context_.status;
  status.SetCounter("pairs", num_pairs_);
  status.SetCounter("single_images", num_singles_);
  status.SetCounter("queue_dropped", queue_.num_dropped());
  status.SetCounter("skew_mean_us", skews_.count > 0 ? skews_.sum_us / skews_.count : 0);
  status.SetCounter("skew_worst_us", skews_.worst_us);
  const std::int64_t unpaired = pairer_.unpaired(Side::kLeft) + pairer_.unpaired(Side::kRight);
  status.Dropped(unpaired - told_unpaired_);
  const std::int64_t now_us = context_.clock->NowUs();
  const bool both = !IsAway(Side::kLeft, now_us) && !IsAway(Side::kRight, now_us);
  // Both send, and nothing fits.
  status.SetCondition("pairs", both && skews_.count == 0 && unpaired > told_unpaired_ + 2
                                   ? "no frames of both cameras within tolerance_ms: are they "
                                     "triggered together?"
                                   : "");
  told_unpaired_ = unpaired;
  skews_ = {};
}

}  // namespace visavis
