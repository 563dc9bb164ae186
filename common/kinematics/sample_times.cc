#include "common/kinematics/sample_times.h"

#include <algorithm>
#include <array>

#include "common/core/check.h"

namespace visavis {
namespace {

constexpr std::int64_t kRestartJumpUs = 1'000'000;

}  // namespace

const char* Name(SampleVerdict verdict) {
  switch (verdict) {
    case SampleVerdict::kAccepted:
      return "accepted";
    case SampleVerdict::kDuplicate:
      return "duplicate";
    case SampleVerdict::kOutOfOrder:
      return "out of order";
    case SampleVerdict::kNotFinite:
      return "not finite";
    case SampleVerdict::kWrongNames:
      return "wrong names";
    case SampleVerdict::kNotRigid:
      return "not rigid";
  }
  return "unknown";
}

void SampleCounts::Count(SampleVerdict verdict) {
  switch (verdict) {
    case SampleVerdict::kAccepted:
      ++accepted;
      break;
    case SampleVerdict::kDuplicate:
      ++duplicate;
      break;
    case SampleVerdict::kOutOfOrder:
      ++out_of_order;
      break;
    case SampleVerdict::kNotFinite:
      ++not_finite;
      break;
    case SampleVerdict::kWrongNames:
      ++wrong_names;
      break;
    case SampleVerdict::kNotRigid:
      ++not_rigid;
      break;
  }
}

SampleTimes::SampleTimes(const HistoryOptions& options) : max_gap_us_(options.max_gap_us) {
  VISAVIS_THROW_UNLESS(options.capacity >= 2, options.capacity);
  VISAVIS_THROW_UNLESS(options.max_gap_us > 0, options.max_gap_us);
  times_us_.resize(static_cast<std::size_t>(options.capacity));
}

std::optional<std::int64_t> SampleTimes::newest_us() const {
  if (size_ == 0) return std::nullopt;
  return TimeOf(size_ - 1);
}

bool SampleTimes::IsRestart(std::int64_t utime_us) const {
  return size_ > 0 && utime_us < TimeOf(size_ - 1) - kRestartJumpUs;
}

SampleVerdict SampleTimes::Judge(std::int64_t utime_us) const {
  if (utime_us < 0) return SampleVerdict::kOutOfOrder;
  if (size_ == 0 || utime_us > TimeOf(size_ - 1) || IsRestart(utime_us)) {
    return SampleVerdict::kAccepted;
  }
  return utime_us == TimeOf(size_ - 1) ? SampleVerdict::kDuplicate : SampleVerdict::kOutOfOrder;
}

void SampleTimes::Clear() { first_ = size_ = 0; }

int SampleTimes::Push(std::int64_t utime_us) {
  if (IsRestart(utime_us)) Clear();
  if (size_ == capacity()) {
    first_ = Slot(1);
  } else {
    ++size_;
  }
  times_us_[Slot(size_ - 1)] = utime_us;
  return Slot(size_ - 1);
}

std::int64_t SampleTimes::MedianInterval() const {
  std::array<std::int64_t, 9> intervals;
  const int n = std::min(size_ - 1, static_cast<int>(intervals.size()));
  for (int i = 0; i < n; ++i) intervals[i] = TimeOf(size_ - 1 - i) - TimeOf(size_ - 2 - i);
  std::nth_element(intervals.begin(), intervals.begin() + n / 2, intervals.begin() + n);
  return intervals[n / 2];
}

std::optional<SampleTimes::Bracket> SampleTimes::Find(std::int64_t utime_us) const {
  if (size_ == 0 || utime_us < TimeOf(0)) return std::nullopt;
  // First sample later than the time, by bisection.
  int lower = 0, upper = size_;
  while (lower < upper) {
    const int middle = (lower + upper) / 2;
    if (TimeOf(middle) <= utime_us) {
      lower = middle + 1;
    } else {
      upper = middle;
    }
  }
  const int after = lower;  // >= 1
  const std::int64_t age_us = utime_us - TimeOf(after - 1);
  const bool extrapolated = after == size_ && age_us > 0;
  if (extrapolated && (size_ < 2 || age_us > std::min(MedianInterval(), max_gap_us_))) {
    return std::nullopt;
  }
  // At or beyond the newest sample the pair is the last two.
  int i_1 = std::min(after, size_ - 1), i_0 = std::max(i_1 - 1, 0);
  if (TimeOf(i_1) - TimeOf(i_0) > max_gap_us_) {
    if (age_us > 0) return std::nullopt;
    // Exactly on a sample with a gap after it: the pair before it, or else that sample alone.
    i_1 = after - 1;
    i_0 = std::max(i_1 - 1, 0);
    if (TimeOf(i_1) - TimeOf(i_0) > max_gap_us_) i_0 = i_1;
  }
  return Bracket{Slot(i_0), Slot(i_1), TimeOf(i_0), TimeOf(i_1), extrapolated, age_us};
}

}  // namespace visavis
