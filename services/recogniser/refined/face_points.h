#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "services/recogniser/refined/head_surface.h"

namespace visavis {

/// Spatial bands of the pictures' brightness: fine from about 2 to 7 mm, coarse from 4 to 14 mm on
/// a head at the working distance.
/// Beside them the brightness itself, but for details below 3 mm: both eyes see the same on the
/// head, while bands of what is slanted differ between them.
inline constexpr std::size_t kNumBands = 2, kNumPlanes = 3;
enum Band : std::size_t { kFineBand, kCoarseBand, kBrightness };

inline constexpr std::size_t kLooksModes = 12;

/// Points on the face where brightness is compared, about 5 mm apart, and what a generic face looks
/// like there: brows, lids and irises, nostrils, mouth are dark.
struct FacePoints {
  std::vector<Eigen::Vector3f> points, normals;  ///< M frame, m
  /// Brightness of a generic face in each band, arbitrary units, mean about 0.
  std::array<std::vector<float>, kNumBands> generic;
  /// Whether the generic face says anything there.
  std::vector<unsigned char> has_generic;
  /// How faces differ there in the fine band: AdultLooks::Place.
  std::vector<float> doubt;
  std::vector<std::array<float, kLooksModes>> modes;

  std::size_t size() const { return points.size(); }
};

FacePoints FacePointsOf(const HeadSurface& surface, double spacing_m);

}  // namespace visavis
