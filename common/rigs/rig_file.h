#pragma once

#include <functional>
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
///     uncertainty: {right: {fx, fy, cx, cy, distortion: [...]}, left: {...},   optional: standard
///                   X_CL: {p_m: [x, y, z], r_rad: [x, y, z]}, X_HC: {...}}     deviations
///
/// @throws ConfigError: one line with file, line, key, value and rule.
RigDescription LoadRigFile(const std::string& filename);

/// Of a configuration's key rig_file: what it names, unless empty, is a rig.yaml that can be read,
/// with the arm's file. @throws FieldError naming the file and what is wrong with it.
void RequireRigFile(const std::string& filename);

/// Reads the text of a rig.yaml. @param name stands for it in errors. @param read_file gives the
/// text of the file that arm.urdf names; throws std::runtime_error where there is none.
RigDescription ParseRig(const std::string& text, const std::string& name,
                        const std::function<std::string(const std::string&)>& read_file);

/// Writes @p rig as a rig.yaml; the arm's URDF goes into arm.urdf beside it.
/// @throws std::runtime_error naming the file that cannot be written.
void SaveRigFile(const RigDescription& rig, const std::string& filename);

}  // namespace visavis
