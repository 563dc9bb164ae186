#pragma once

#include <memory>
#include <string>
#include <vector>

#include "services/arm_state/sources/arm_source.h"

namespace visavis {

/// One kind of source.
struct SourceKind {
  const char* name;     ///< as `source:` in the configuration, and in ARM_STATE
  const char* channel;  ///< where it listens unless told; empty: it does not
  std::unique_ptr<ArmSource> (*make)(const SourceContext&);
};

/// All kinds. A new arm is one line more.
const std::vector<SourceKind>& SourceKinds();

/// @throws std::invalid_argument for a name that is none.
const SourceKind& FindSourceKind(const std::string& name);

}  // namespace visavis
