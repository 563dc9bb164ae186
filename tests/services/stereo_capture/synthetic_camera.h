#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "common/core/random.h"

namespace visavis {

/// One simulated camera: when its frames are exposed in true host time, what its own clock says of
/// it, and when they arrive. Exponential delays, of which a few are long.
struct SyntheticCamera {
  std::uint64_t seed{1};
  double period_us{1e6 / 30};
  double first_us{1.7e15};          ///< host time of the first exposure
  double clock_offset_us{-1.6e15};  ///< camera's clock minus host's, at the first exposure
  double drift_ppm{0};              ///< how much faster the camera's clock runs
  double least_delay_us{150}, mean_jitter_us{200};
  double long_delay_share{0.01}, long_delay_us{8000};
  double lost_share{0};

  struct Arrival {
    std::uint64_t frame;
    std::int64_t true_us, device_ns, arrival_us;
  };

  /// Frame @p n; nothing if it was lost. To be called with ascending n.
  std::optional<Arrival> Frame(std::uint64_t n) {
    if (!random) random.emplace(seed);
    const double since_us = static_cast<double>(n) * period_us;
    double delay_us = least_delay_us - mean_jitter_us * std::log(1 - random->Uniform());
    if (random->Uniform() < long_delay_share) delay_us += long_delay_us * random->Uniform();
    if (random->Uniform() < lost_share) return std::nullopt;
    const double device_us = first_us + clock_offset_us + since_us * (1 + 1e-6 * drift_ppm);
    return Arrival{n, std::llround(first_us + since_us), std::llround(device_us) * 1000,
                   std::llround(first_us + since_us + delay_us)};
  }

  std::optional<Random> random{};
};

}  // namespace visavis
