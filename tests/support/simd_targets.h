#pragma once

#include <string>
#include <vector>

namespace visavis {

/// SimdTargets() as a list: at least one.
std::vector<std::string> ListSimdTargets();

/// Index of the target that the last call of a kernel took: differs from target to target.
std::size_t ChosenSimdTarget();

}  // namespace visavis
