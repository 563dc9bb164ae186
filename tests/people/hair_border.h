#pragma once

#include <vector>

#include "services/recogniser/refined/icosphere.h"

namespace visavis {

/// By vertex the distance [m] to where the share of heads with hair is a half, on the surface of
/// radii @p radii_m: positive where more have it (@p hair_share, 0 to 1).
std::vector<float> HairSides(const Icosphere& sphere, const std::vector<float>& radii_m,
                             const std::vector<double>& hair_share);

}  // namespace visavis
