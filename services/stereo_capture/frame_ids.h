#pragma once

#include <cstdint>
#include <optional>

namespace visavis {

/// Counts the frames that are missing between those that came, by the numbers the camera gives
/// them: 16 bits in GigE Vision 1, where 0 follows 65535 on some cameras and 1 on others; 64 bits
/// elsewhere.
class FrameIds {
 public:
  /// @return how many frames are missing before this one; 0 for the first, and for a number that
  /// repeats or steps back (a camera that began anew).
  std::int64_t Add(std::uint64_t id) {
    const auto last = last_;
    last_ = id;
    if (!last) return 0;
    if (id > *last) return static_cast<std::int64_t>(id - *last) - 1;
    if (*last > kWrap - 1 || id == *last) return 0;
    std::int64_t missing = static_cast<std::int64_t>(kWrap + id - *last) - 1;
    if (missing > kMaxAcrossWrap) return 0;
    // Whether there ever was a 0 cannot be told: in doubt nothing was lost.
    if (id > 0 && missing > 0) --missing;
    return missing;
  }
  void Reset() { last_.reset(); }

 private:
  static constexpr std::uint64_t kWrap = 65536;
  static constexpr std::int64_t kMaxAcrossWrap = 1000;
  std::optional<std::uint64_t> last_;
};

}  // namespace visavis
