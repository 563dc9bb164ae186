#include "services/stereo_capture/aravis_trigger.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/clock.h"
#include "services/stereo_capture/aravis_error.h"

namespace visavis {
namespace {

constexpr std::int64_t kMaxWaitUs = 20'000;
constexpr std::int64_t kMaxLeadUs = 20'000;          // of an action's packet before its time
constexpr std::int64_t kOffsetPeriodUs = 5'000'000;  // host and PTP drift apart by some 0.1 ms then

bool Has(ArvCamera* camera, const char* feature) {
  GlibError error;
  const bool has = arv_camera_is_feature_available(camera, feature, error.out());
  return has && !error;
}

}  // namespace

AravisTrigger::AravisTrigger(ArvCamera* camera, std::string address, const CameraConfig& config)
    : camera_(camera),
      address_(std::move(address)),
      trigger_(config.trigger),
      period_us_(std::llround(1e6 * config.period_s())) {}

std::uint64_t AravisTrigger::Pull() {
  const std::int64_t now_us = SystemClock().NowUs();
  std::int64_t wait_us = kMaxWaitUs;
  if (trigger_ == "software") wait_us = PullBySoftware(now_us);
  if (trigger_ == "action") wait_us = ScheduleAction(now_us);
  return static_cast<std::uint64_t>(std::clamp<std::int64_t>(wait_us, 0, kMaxWaitUs));
}

std::int64_t AravisTrigger::PullBySoftware(std::int64_t now_us) {
  if (now_us >= next_us_) {
    GlibError error;
    arv_camera_software_trigger(camera_, error.out());
    ThrowOnError(error, "software trigger");
  }
  next_us_ = (now_us / period_us_ + 1) * period_us_;
  return next_us_ - SystemClock().NowUs();
}

std::int64_t AravisTrigger::ScheduleAction(std::int64_t now_us) {
  if (now_us >= offset_until_us_ || now_us < offset_until_us_ - kOffsetPeriodUs) {
    offset_us_ = ReadClockOffset();
    offset_until_us_ = now_us + kOffsetPeriodUs;
    now_us = SystemClock().NowUs();
  }
  // No more than one action waits in a camera.
  const std::int64_t lead_us = std::min(kMaxLeadUs, period_us_ / 2);
  const std::int64_t camera_us = now_us + offset_us_;
  if (std::abs(next_us_ - camera_us) > 2 * period_us_)
    next_us_ = 0;  // the first, or a clock was set
  if (next_us_ == 0) next_us_ = ((camera_us + lead_us) / period_us_ + 1) * period_us_;
  if (camera_us >= next_us_ - lead_us) {
    if (++number_ == 0) ++number_;
    SendToCamera(ScheduledAction(kActionKeys, 1000 * static_cast<std::uint64_t>(next_us_), number_),
                 address_);
    next_us_ += period_us_;
  }
  return next_us_ - lead_us - camera_us;
}

std::int64_t AravisTrigger::ReadClockOffset() const {
  const std::pair<const char*, const char*> names[] = {
      {"TimestampLatch", "TimestampLatchValue"}, {"GevTimestampControlLatch", "GevTimestampValue"}};
  for (const auto& [latch, value] : names) {
    if (!Has(camera_, latch) || !Has(camera_, value)) continue;
    GlibError error;
    const std::int64_t before_us = SystemClock().NowUs();
    arv_camera_execute_command(camera_, latch, error.out());
    const std::int64_t after_us = SystemClock().NowUs();
    ThrowOnError(error, latch);
    const std::int64_t camera_ns = arv_camera_get_integer(camera_, value, error.out());
    ThrowOnError(error, value);
    return camera_ns / 1000 - (before_us + after_us) / 2;
  }
  throw CameraRefusal(
      "camera.trigger: action: this camera has neither TimestampLatch nor "
      "GevTimestampControlLatch");
}

}  // namespace visavis
