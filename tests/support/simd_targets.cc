#include "tests/support/simd_targets.h"

#include <hwy/targets.h>

#include <sstream>

#include "services/recogniser/fitness_kernel.h"

namespace visavis {

std::vector<std::string> ListSimdTargets() {
  std::vector<std::string> targets;
  std::istringstream names(SimdTargets());
  for (std::string name; std::getline(names, name, ',');) targets.push_back(name);
  return targets;
}

std::size_t ChosenSimdTarget() { return hwy::GetChosenTarget().GetIndex(); }

}  // namespace visavis
