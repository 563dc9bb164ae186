#include "services/recogniser/chosen_head.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "common/config/config_error.h"
#include "services/recogniser/head_file.h"
#include "services/recogniser/mesh_head.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

constexpr int kLevel = 5;  ///< of the icosphere that holds an ellipsoid

bool EndsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Where the ray from M's origin leaves the ellipsoid; the origin lies inside.
float RadiusOf(const Vector3d& axes, const Vector3d& centre, const Vector3d& direction) {
  const Vector3d d = direction.cwiseQuotient(axes), c = centre.cwiseQuotient(axes);
  const double half = d.dot(c), square = d.squaredNorm();
  return static_cast<float>((half + std::sqrt(half * half + square * (1 - c.squaredNorm()))) /
                            square);
}

HeadGeometry EllipsoidHead(const Vector3d& axes_mm, const HeadModelConfig& sizes) {
  const Vector3d axes = 1e-3 * axes_mm;
  const double x = 1e-3 * sizes.eye_x_mm / axes.x(), y = 1e-3 * sizes.eye_y_mm / axes.y();
  if (!(x * x + y * y < 0.8)) {
    throw FieldError("refined.head.shape", "ellipsoid or sphere",
                     "must have its eyes in front: head.eye_x_mm, head.eye_y_mm are beside it");
  }
  const Vector3d eyes(0, 1e-3 * sizes.eye_y_mm, -axes.z() * std::sqrt(1 - x * x - y * y));
  HeadGeometry head;
  head.p_MR_m = AdultEyes() - eyes;
  if (!(head.p_MR_m.cwiseQuotient(axes).norm() < 0.8)) {
    throw FieldError("refined.head.shape", "ellipsoid or sphere",
                     "must reach round the point behind its eyes: head.semi_axis_*_mm, "
                     "head.radius_mm do not");
  }
  HeadShape shape;
  const HeadShape adult;
  shape.eye_x = static_cast<float>(1e-3 * sizes.eye_x_mm);
  shape.brow_y =
      adult.eye_y +
      static_cast<float>(1e-3 * (sizes.brow_y_mm - sizes.eye_y_mm - 0.5 * sizes.brow_arch_mm));
  // The published plane is told by its lean from the vertical normal, this one by its normal's.
  shape.hair_tilt_rad = static_cast<float>((90 - sizes.hair_tilt_deg) * M_PI / 180);
  const auto at_origin = static_cast<double>(shape.hair_normal().dot(head.p_MR_m.cast<float>()));
  shape.hair_offset = static_cast<float>(1e-3 * sizes.hair_offset_mm + at_origin);
  HeadTable table;
  const Icosphere sphere(kLevel);
  for (const Eigen::Vector3f& d : sphere.vertices()) {
    table.radii_m.push_back(RadiusOf(axes, head.p_MR_m, d.cast<double>()));
  }
  const float least = *std::min_element(table.radii_m.begin(), table.radii_m.end());
  if (!(least >= HeadTable::kMinRadius_m)) {
    throw FieldError("refined.head.shape", "ellipsoid or sphere",
                     "must reach " + std::to_string(std::lround(1e3 * HeadTable::kMinRadius_m)) +
                         " mm from the point behind its eyes to all sides: head.radius_mm, "
                         "head.semi_axis_*_mm are too small");
  }
  head.surface = HeadSurface(shape, table);
  return head;
}

HeadGeometry FileHead(const HeadChoice& choice) {
  if (EndsWith(choice.file, ".yaml") || EndsWith(choice.file, ".yml")) {
    return LoadHeadFile(choice.file);
  }
  MeshFileOptions options;
  options.scale = choice.scale;
  options.y_up = choice.y_up;
  Vector3d p_M_of_mesh;
  HeadGeometry head = HeadFromMesh(LoadLabelledMesh(choice.file, options), &p_M_of_mesh);
  head.is_measured = choice.measured;
  head.p_MR_m = AdultOrigin();
  if (choice.origin_m.empty()) return head;
  const Vector3d origin(choice.origin_m[0], choice.origin_m[1], choice.origin_m[2]);
  const Vector3d axes = choice.y_up ? Vector3d(1, -1, -1) : Vector3d::Ones();
  head.p_MR_m = origin.cwiseProduct(axes) - p_M_of_mesh;
  return head;
}

}  // namespace

HeadGeometry ChosenHead(const HeadChoice& choice, const HeadModelConfig& sizes) {
  for (const double x : choice.origin_m) {
    if (choice.origin_m.size() == 3 && std::abs(x) <= 1e3) continue;
    throw FieldError("refined.head.origin_m", std::to_string(x),
                     "must be three numbers within +-1000 m, or none");
  }
  if (choice.file.empty()) {
    if (choice.shape == "adult") return {TheAdult().surface, AdultOrigin(), std::nullopt};
    const bool is_sphere = choice.shape == "sphere";
    return EllipsoidHead(
        is_sphere ? Vector3d::Constant(sizes.radius_mm)
                  : Vector3d(sizes.semi_axis_x_mm, sizes.semi_axis_y_mm, sizes.semi_axis_z_mm),
        sizes);
  }
  try {
    return FileHead(choice);
  } catch (const std::invalid_argument& e) {
    // Readers name the file first; so does the key's value.
    std::string reason = e.what();
    if (reason.compare(0, choice.file.size() + 1, choice.file + ":") == 0) {
      reason.erase(0, choice.file.size() + 1);
      if (!reason.empty() && reason[0] == ' ') reason.erase(0, 1);
      if (!reason.empty() && std::isdigit(static_cast<unsigned char>(reason[0]))) {
        reason = "line " + reason;
      }
    }
    throw FieldError("refined.head.file", choice.file, reason);
  }
}

}  // namespace visavis
