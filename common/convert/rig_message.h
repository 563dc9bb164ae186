#pragma once

#include "common/rigs/rig_description.h"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {

/// @throws MessageError naming field, value and rule.
RigDescription FromMessage(const stereo_rig_t& message);

stereo_rig_t ToMessage(const RigDescription& description, std::int64_t utime);

}  // namespace visavis
