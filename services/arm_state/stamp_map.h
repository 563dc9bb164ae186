#pragma once

#include <array>
#include <cstdint>

namespace visavis {

/// Maps the times of a clock of unknown origin to host time: plus the least difference of arrival
/// and stamp of the last two seconds, which is the clocks' offset and the shortest way. A drift of
/// 50 ppm thus costs 0.1 ms at most. Allocates nothing.
class StampMap {
 public:
  StampMap() { Reset(); }

  /// Host time [us] of @p stamp_us, which arrived at @p arrival_us. Later than the last one, unless
  /// the host's clock was set back by more than 1 s.
  std::int64_t Map(std::int64_t stamp_us, std::int64_t arrival_us);

  /// Forgets all: the other clock was set.
  void Reset();

 private:
  static constexpr std::int64_t kRestartUs = 1'000'000;
  static constexpr std::int64_t kBucketUs = 100'000;
  static constexpr std::int64_t kNone = INT64_MAX;
  std::array<std::int64_t, 20> least_us_;  ///< differences, a bucket a slot
  std::int64_t bucket_{kNone};             ///< the newest, counted in arrival time
  std::int64_t last_us_{-1};
};

}  // namespace visavis
