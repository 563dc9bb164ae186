#pragma once

#include <cstdint>

namespace visavis {

/// One camera's view of one pose, single precision, all lengths in metres. A disc point (u, v)
/// lies at `disc * (u, v, h) + origin` in the camera's frame, with h = sqrt(1 - rho2 (u^2 + v^2))
/// on the surface and h = contour_h on the plane of the tangent contour; a model point p_M at
/// `model * p_M + origin`. Rows 0 and 1 and the origin's x and y carry the focal length, so that a
/// pixel is (x / z + cx, y / z + cy).
struct FitnessView {
  float disc[3][3];
  float model[3][3];
  float origin[3];
  float hair[3];  ///< hair where hair . (u, v, h) > hair_offset
  float hair_offset;
  float rho2;
  float contour_h;
  float cx, cy;  ///< [px] with +1 for the border and +0.5 for rounding
};

/// The map's memory (see PackedMap), border included.
struct FitnessMap {
  const std::uint32_t* pixels;
  int stride;          ///< [pixels]
  float max_x, max_y;  ///< last column and row, border included
};

/// The model's points; counts are multiples of 16.
struct FitnessPoints {
  const float *in_u, *in_v;
  const float *out_u, *out_v;
  const float *feature_x, *feature_y, *feature_z;
  int num_in, num_out, num_feature_in, num_feature;
};

/// Sums over one camera, bytes of the map: exact integers, so the same on every SIMD target.
struct FitnessSums {
  std::int32_t site_in{0};      ///< p over S_in, Eq. 24
  std::int32_t site_out{0};     ///< p over S_out, Eq. 24
  std::int32_t color{0};        ///< h over the skin part plus b over the hair part, Eq. 28
  std::int32_t feature_in{0};   ///< p over F_in, Eq. 30
  std::int32_t feature_out{0};  ///< p over F_out, Eq. 30
};

/// Projects all points and adds up the map under them (Eqs. 24, 28, 30). z must be positive at
/// every point; pixels outside the image read the border.
void SumFitness(const FitnessView& view, const FitnessMap& map, const FitnessPoints& points,
                FitnessSums* sums);

/// Restricts dispatch to the named target and worse ones: "auto", or one of SimdTargets().
/// @throws std::invalid_argument for a name this machine does not offer. Process-wide: call at
/// start.
void SelectSimdTarget(const char* name);

/// Comma-separated names of the targets that this machine and build offer, best first.
const char* SimdTargets();

}  // namespace visavis
