#include "services/recogniser/refined/distance_ranges.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

constexpr double kBeyond = 1.04;  ///< a head may leave its part by this factor
constexpr double kNearest_m = 0.1;

}  // namespace

DistanceRanges::DistanceRanges(const StereoRig& rig, const SearchSpace& space) {
  const double near = std::max(space.min[2], kNearest_m);
  const double ratio = std::max(space.max[2] / near, 1.0);
  const int count = std::max(1, static_cast<int>(std::ceil(std::log2(ratio) - 1e-9)));
  for (int i = 0; i < count; ++i) {
    SearchSpace part = space;
    if (i > 0) part.min[2] = near * std::pow(ratio, static_cast<double>(i) / count);
    if (i + 1 < count) part.max[2] = near * std::pow(ratio, (i + 1.0) / count);
    ranges_.push_back({part, WorkingPair(rig, part)});
  }
}

std::size_t DistanceRanges::At(double z_m) const {
  std::size_t i = 0;
  while (i + 1 < ranges_.size() && z_m > ranges_[i].space.max[2]) ++i;
  return i;
}

std::size_t DistanceRanges::At(double z_m, std::size_t current) const {
  const SearchSpace& space = ranges_[current].space;
  const bool is_within = z_m > space.min[2] / kBeyond && z_m < space.max[2] * kBeyond;
  return is_within ? current : At(z_m);
}

int DistanceRanges::width() const {
  int most = 0;
  for (const Range& range : ranges_)
    most = std::max({most, range.pair.eye(0).width, range.pair.eye(1).width});
  return most;
}

int DistanceRanges::height() const {
  int most = 0;
  for (const Range& range : ranges_)
    most = std::max({most, range.pair.eye(0).height, range.pair.eye(1).height});
  return most;
}

}  // namespace visavis
