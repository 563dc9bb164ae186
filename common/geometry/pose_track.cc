#include "common/geometry/pose_track.h"

#include <algorithm>
#include <utility>

namespace visavis {
namespace {

bool IsEarlier(const StampedPose& a, const StampedPose& b) { return a.utime_us < b.utime_us; }

}  // namespace

PoseTrack::PoseTrack(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  std::stable_sort(poses_.begin(), poses_.end(), IsEarlier);
  // unique() keeps the first of equal times: go from the back, so that the last counts.
  const auto first = std::unique(
      poses_.rbegin(), poses_.rend(),
      [](const StampedPose& a, const StampedPose& b) { return a.utime_us == b.utime_us; });
  poses_.erase(poses_.begin(), first.base());
}

const RigidTransform* PoseTrack::Find(std::int64_t utime_us) const {
  const auto next =
      std::lower_bound(poses_.begin(), poses_.end(), StampedPose{utime_us, {}}, IsEarlier);
  return next != poses_.end() && next->utime_us == utime_us ? &next->X : nullptr;
}

std::optional<RigidTransform> PoseTrack::At(std::int64_t utime_us, std::int64_t max_gap_us) const {
  const auto next =
      std::lower_bound(poses_.begin(), poses_.end(), StampedPose{utime_us, {}}, IsEarlier);
  if (next == poses_.end()) return std::nullopt;
  if (next->utime_us == utime_us) return next->X;
  if (next == poses_.begin()) return std::nullopt;
  const auto last = next - 1;
  const std::int64_t gap_us = next->utime_us - last->utime_us;
  if (gap_us > max_gap_us) return std::nullopt;
  return Interpolate(last->X, next->X,
                     static_cast<double>(utime_us - last->utime_us) / static_cast<double>(gap_us));
}

}  // namespace visavis
