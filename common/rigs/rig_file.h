#pragma once

#include <string>

#include "common/rigs/rig_description.h"

namespace visavis {

/// Reads a rig.yaml:
///
///     right: {width, height, fx, fy, cx, cy, distortion: [k1, k2, p1, p2, k3]}
///     left: {...}
///     X_CL: {p_m: [x, y, z], q_wxyz: [w, x, y, z]}
///     X_HC: {...}                                            optional
///     arm: {urdf: FILE, base: LINK, tip: LINK, X_WB: {...}}  optional; FILE beside the rig.yaml
///
/// @throws ConfigError: one line with file, line, key, value and rule.
RigDescription LoadRigFile(const std::string& filename);

/// Writes @p rig as a rig.yaml; the arm's URDF goes into arm.urdf beside it.
/// @throws std::runtime_error naming the file that cannot be written.
void SaveRigFile(const RigDescription& rig, const std::string& filename);

}  // namespace visavis
