#pragma once

#include <cstdint>

#include "services/simulator/subject.h"

namespace visavis {

/// Somebody at random, the same for the same @p number: sizes as they vary among adults, any hair,
/// skin and clothes.
Subject Anybody(std::uint64_t number);

}  // namespace visavis
