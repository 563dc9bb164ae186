#pragma once

#include <ostream>

#include "tests/people/trained_head.h"

namespace visavis {

/// Prints how far a newly trained head is from the one that this program was built with:
/// differences of radii, their deviations and the border of the hair; correlations of the looks;
/// how much of the old modes' variance lies in the span of the new ones.
void PrintComparison(const TrainedHead& head, std::ostream* out);

}  // namespace visavis
