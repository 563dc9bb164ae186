#pragma once

#include <string>

#include "services/simulator/figure.h"

namespace visavis {

/// Writes the head of @p figure as a closed OBJ, the neck cut flat, with materials named by what
/// each triangle shows (skin, hair, eye, ...); beside it FILE.mtl. Metres, x right, y up, z to the
/// viewer, origin at M's. Ears and hair that hangs down are left out.
/// @throws std::runtime_error naming a file that cannot be written.
void ExportHead(const Figure& figure, const std::string& filename);

}  // namespace visavis
