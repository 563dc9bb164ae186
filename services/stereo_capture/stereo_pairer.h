#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace visavis {

enum class Side { kLeft = 0, kRight = 1 };

inline Side Other(Side side) { return side == Side::kLeft ? Side::kRight : Side::kLeft; }
inline const char* SideName(Side side) { return side == Side::kLeft ? "left" : "right"; }
inline std::size_t Index(Side side) { return static_cast<std::size_t>(side); }

/// Joins the frames of two cameras whose mid-exposures in host time are close. With a tolerance
/// below half a period a frame has at most one partner; what has none is counted and given up.
template <typename Frame>
class StereoPairer {
 public:
  struct Timed {
    std::int64_t utime_us;  ///< mid-exposure, host time
    Frame frame;
  };
  struct Pair {
    Timed left, right;
    std::int64_t skew_us() const { return left.utime_us - right.utime_us; }
  };

  /// @param max_waiting frames of one side that may wait for the other's
  explicit StereoPairer(std::int64_t tolerance_us, std::size_t max_waiting = 4)
      : tolerance_us_(tolerance_us), max_waiting_(max_waiting) {}

  /// Takes the next frame of one side. @return the pair that it completes.
  std::optional<Pair> Add(Side side, std::int64_t utime_us, Frame frame) {
    auto& own = waiting_[Index(side)];
    auto& other = waiting_[Index(Other(side))];
    // Times of one side ascend: what lies before this one's reach has no partner any more.
    while (!other.empty() && other.front().utime_us < utime_us - tolerance_us_)
      GiveUpOldest(Other(side));
    Timed timed{utime_us, std::move(frame)};
    if (other.empty() || other.front().utime_us > utime_us + tolerance_us_) {
      if (own.size() == max_waiting_) GiveUpOldest(side);
      own.push_back(std::move(timed));
      return std::nullopt;
    }
    while (!own.empty()) GiveUpOldest(side);
    Timed partner = std::move(other.front());
    other.pop_front();
    if (side == Side::kLeft) return Pair{std::move(timed), std::move(partner)};
    return Pair{std::move(partner), std::move(timed)};
  }

  /// Gives up what waits of one side: its camera, or the other's, is away.
  void Clear(Side side) {
    while (!waiting_[Index(side)].empty()) GiveUpOldest(side);
  }

  /// Frames of one side that found no partner.
  std::int64_t unpaired(Side side) const { return unpaired_[Index(side)]; }

 private:
  void GiveUpOldest(Side side) {
    waiting_[Index(side)].pop_front();
    ++unpaired_[Index(side)];
  }

  const std::int64_t tolerance_us_;
  const std::size_t max_waiting_;
  std::array<std::deque<Timed>, 2> waiting_;
  std::array<std::int64_t, 2> unpaired_{};
};

}  // namespace visavis
