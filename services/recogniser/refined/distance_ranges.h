#pragma once

#include <cstddef>
#include <vector>

#include "services/recogniser/refined/working_pair.h"
#include "services/recogniser/search_space.h"

namespace visavis {

/// A search space cut along the optical axis, so that within a part a head looks about as large
/// everywhere: each part spans an octave of distance at most and has pictures of its own
/// resolution. What is nearer than 0.1 m is taken to be there.
class DistanceRanges {
 public:
  /// @throws std::invalid_argument as WorkingPair.
  DistanceRanges(const StereoRig& rig, const SearchSpace& space);

  std::size_t size() const { return ranges_.size(); }
  /// The part's poses: the whole space's but for the distance.
  const SearchSpace& space(std::size_t i) const { return ranges_[i].space; }
  WorkingPair& pair(std::size_t i) { return ranges_[i].pair; }
  const WorkingPair& pair(std::size_t i) const { return ranges_[i].pair; }
  /// The part that @p z_m [m] lies in, or the nearest; @p current until it is well beyond that, so
  /// that a head at the border does not change the resolution in every frame.
  std::size_t At(double z_m, std::size_t current) const;
  std::size_t At(double z_m) const;
  /// The largest width and height of working pictures [px].
  int width() const;
  int height() const;

 private:
  struct Range {
    SearchSpace space;
    WorkingPair pair;
  };
  std::vector<Range> ranges_;
};

}  // namespace visavis
