#pragma once

#include <cstdint>
#include <string>

#include "common/gige/gobject.h"
#include "common/gige/gvcp_action.h"
#include "services/stereo_capture/camera_config.h"

namespace visavis {

/// What both cameras' registers are set to for trigger: action.
inline constexpr ActionKeys kActionKeys{};

/// Pulls one camera's trigger, where that is this program's to do. Both cameras are pulled at the
/// same ticks, multiples of the period: of the host's clock by software; by scheduled actions, of
/// the clock that the cameras share by PTP, so that both expose at the very same time.
class AravisTrigger {
 public:
  /// @p camera aliased @param address of a GigE camera
  AravisTrigger(ArvCamera* camera, std::string address, const CameraConfig& config);

  /// Does what is due. @return how long until the next thing is [us], at most some 20 ms.
  /// @throws CameraLost, or CameraRefusal where an action's camera cannot tell its time.
  std::uint64_t Pull();

 private:
  std::int64_t PullBySoftware(std::int64_t now_us);
  std::int64_t ScheduleAction(std::int64_t now_us);
  /// The camera's clock less the host's [us].
  std::int64_t ReadClockOffset() const;

  ArvCamera* const camera_;
  const std::string address_;
  const std::string trigger_;
  const std::int64_t period_us_;
  std::int64_t next_us_{0};  // tick that is due next: by the host's clock, or the camera's
  std::int64_t offset_us_{0}, offset_until_us_{0};
  std::uint16_t number_{0};
};

}  // namespace visavis
