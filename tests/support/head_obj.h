#pragma once

#include <functional>
#include <string>

#include "services/recogniser/refined/head_geometry.h"

namespace visavis {

/// How a head is written as OBJ; each default makes a good file.
struct HeadObj {
  double units_per_m{1};
  bool y_up{true};
  Eigen::Vector3d shift_m{0, 0, 0};  ///< of the whole, in M's axes
  int level{4};                      ///< of the icosphere
  int leave_out{0};                  ///< triangles that are not written
  /// The material of a triangle with its middle at @p p_M.
  std::function<std::string(const Eigen::Vector3f& p_M)> material;
  /// Where a vertex goes.
  std::function<Eigen::Vector3f(const Eigen::Vector3f& p_M)> place;
};

/// skin, hair, eye, brow, lips: where the generic adult has them.
std::string AdultMaterial(const Eigen::Vector3f& p_M);

/// Writes @p surface to @p folder as head.obj and head.mtl. @return the OBJ's name.
std::string WriteHeadObj(const std::string& folder, const HeadSurface& surface,
                         const HeadObj& how = {});

}  // namespace visavis
