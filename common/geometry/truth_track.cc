#include "common/geometry/truth_track.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace visavis {
namespace {

constexpr std::int64_t kMaxGapUs = 100'000;

bool IsEarlier(const TruthSample& a, const TruthSample& b) { return a.utime_us < b.utime_us; }

bool IsFar(const RigidTransform& X_0, const RigidTransform& X_1) {
  const Eigen::Matrix3d R_01 = X_0.linear().transpose() * X_1.linear();
  return (X_1.translation() - X_0.translation()).norm() > TruthTrack::kJump_m ||
         LogRotation(R_01).norm() > TruthTrack::kJump_rad;
}

bool IsJump(const TruthSample& a, const TruthSample& b) {
  if (!b.X_CM) return false;
  if (!a.X_CM) return true;
  return a.X_WM && b.X_WM ? IsFar(*a.X_WM, *b.X_WM) : IsFar(*a.X_CM, *b.X_CM);
}

}  // namespace

TruthTrack::TruthTrack(std::vector<TruthSample> samples,
                       const std::vector<std::int64_t>& frame_utimes_us)
    : samples_(std::move(samples)) {
  std::stable_sort(samples_.begin(), samples_.end(), IsEarlier);
  // unique() keeps the first of equal times: go from the back, so that the last counts.
  const auto first = std::unique(
      samples_.rbegin(), samples_.rend(),
      [](const TruthSample& a, const TruthSample& b) { return a.utime_us == b.utime_us; });
  samples_.erase(samples_.begin(), first.base());

  for (std::size_t i = 1; i < samples_.size(); ++i) {
    if (IsJump(samples_[i - 1], samples_[i])) jump_utimes_us_.push_back(samples_[i].utime_us);
  }
  const auto partners = static_cast<std::size_t>(
      std::count_if(frame_utimes_us.begin(), frame_utimes_us.end(), [this](std::int64_t utime_us) {
        return std::binary_search(samples_.begin(), samples_.end(), TruthSample{utime_us, {}, {}},
                                  IsEarlier);
      }));
  synchronous_ = 2 * partners >= std::min(samples_.size(), frame_utimes_us.size());
  if (synchronous_) return;
  for (std::int64_t& utime_us : jump_utimes_us_) utime_us -= kSameExposure_us;
}

std::optional<TruthSample> TruthTrack::At(std::int64_t utime_us) const {
  const auto next =
      std::lower_bound(samples_.begin(), samples_.end(), TruthSample{utime_us, {}, {}}, IsEarlier);
  if (next == samples_.end()) return std::nullopt;
  if (next->utime_us == utime_us) return *next;
  if (synchronous_ || next == samples_.begin()) return std::nullopt;
  const TruthSample& last = *(next - 1);
  const std::int64_t gap_us = next->utime_us - last.utime_us;
  if (gap_us > kMaxGapUs) return std::nullopt;
  if (last.X_CM.has_value() != next->X_CM.has_value() || IsJump(last, *next)) {
    const TruthSample& nearest = 2 * (utime_us - last.utime_us) < gap_us ? last : *next;
    if (std::abs(nearest.utime_us - utime_us) > kSameExposure_us) return std::nullopt;
    return nearest;
  }
  if (!last.X_CM) return TruthSample{utime_us, {}, {}};
  const double s = static_cast<double>(utime_us - last.utime_us) / static_cast<double>(gap_us);
  return TruthSample{utime_us, Interpolate(*last.X_CM, *next->X_CM, s), {}};
}

}  // namespace visavis
