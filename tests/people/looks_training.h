#pragma once

#include <vector>

#include "tests/people/looks_sampler.h"
#include "tests/people/trained_head.h"

namespace visavis {

/// The pictures of a recording.
struct RecordedLooks {
  std::vector<LooksView> views;
  double weight;  ///< of sum 1 over all
};

/// The mean look and how looks differ. Light and exposure go into a gain and an offset of each
/// picture, by band, that fit it to the mean; a recording counts as the mean of its pictures, as it
/// is and mirrored. @p on_face: the cells whose contrast is the unit, and that gains are fitted to.
LooksModel TrainLooks(const LooksGrid& grid, const std::vector<RecordedLooks>& recordings,
                      const std::vector<bool>& on_face);

}  // namespace visavis
