#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace visavis {

/// What became of a sample offered to a history.
enum class SampleVerdict {
  kAccepted,
  kDuplicate,   ///< same time as the newest
  kOutOfOrder,  ///< older than the newest by at most 1 s, or negative
  kNotFinite,   ///< NaN or infinity in it
  kWrongNames,  ///< a joint of the arm is missing or named twice, or sizes differ
  kNotRigid,    ///< a pose whose rotation is none
};

/// One word for logs and status.
const char* Name(SampleVerdict verdict);

/// Samples since construction, by verdict.
struct SampleCounts {
  std::int64_t accepted{0}, duplicate{0}, out_of_order{0}, not_finite{0}, wrong_names{0},
      not_rigid{0};
  std::int64_t restarts{0};  ///< backward jumps of more than 1 s: a new session began

  void Count(SampleVerdict verdict);
  std::int64_t rejected() const {
    return duplicate + out_of_order + not_finite + wrong_names + not_rigid;
  }
};

struct HistoryOptions {
  /// Samples kept, >= 2. 1024 is a second of a 1 kHz arm: far more than an image is late.
  int capacity{1024};
  /// Neighbours farther apart are not interpolated [us], > 0. At 100 ms the cubic of JointHistory
  /// errs by 0.08 mm on a shuttle of 150 mm and T = 1 s.
  std::int64_t max_gap_us{100'000};
};

/// Times of a ring of samples: which slot a new sample takes, and which slots surround a time.
/// Allocates at construction only.
class SampleTimes {
 public:
  /// @throws std::invalid_argument naming the option.
  explicit SampleTimes(const HistoryOptions& options);

  /// kAccepted, kDuplicate or kOutOfOrder; changes nothing.
  SampleVerdict Judge(std::int64_t utime_us) const;

  /// True if @p utime_us lies more than 1 s before the newest sample: a new session.
  bool IsRestart(std::int64_t utime_us) const;

  /// Appends a time judged kAccepted, forgetting all others first at a restart. Returns its slot in
  /// 0 .. capacity - 1.
  int Push(std::int64_t utime_us);

  void Clear();

  int size() const { return size_; }
  /// Time of the newest sample; none while empty.
  std::optional<std::int64_t> newest_us() const;

  /// The two samples by which a time is interpolated.
  struct Bracket {
    int slot_0, slot_1;  ///< slots of the earlier and the later sample; equal if one is alone
    std::int64_t t_0_us, t_1_us;
    bool extrapolated;    ///< time is later than both
    std::int64_t age_us;  ///< time minus that of the newest sample not after it
  };

  /// None if the time is before the oldest sample, in too wide a gap, or later than the newest by
  /// more than one period (the median of the last intervals, at most nine).
  std::optional<Bracket> Find(std::int64_t utime_us) const;

 private:
  int capacity() const { return static_cast<int>(times_us_.size()); }
  /// Slot of the @p i-th oldest sample.
  int Slot(int i) const { return (first_ + i) % capacity(); }
  std::int64_t TimeOf(int i) const { return times_us_[Slot(i)]; }
  std::int64_t MedianInterval() const;

  std::vector<std::int64_t> times_us_;
  std::int64_t max_gap_us_;
  int first_{0}, size_{0};
};

}  // namespace visavis
