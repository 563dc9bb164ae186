#pragma once

#include <vector>

#include "services/simulator/head_shape.h"
#include "services/simulator/subject.h"

namespace visavis {

/// The skin of head and neck (and hair that lies on it) sampled on a grid: columns run round the
/// head from the back over the image's left to the face (the middle) and on; rows from the vertex
/// to the base of the neck. Finer in the face.
struct HeadGrid {
  int columns, rows;
  /// Average coordinates [mm] of the bare skin, (columns + 1) x (rows + 1), row by row.
  std::vector<Eigen::Vector3d> skin;
  /// The same with the hair on it.
  std::vector<Eigen::Vector3d> outer;

  const Eigen::Vector3d& skin_at(int i, int j) const {
    return skin[static_cast<std::size_t>(j * (columns + 1) + i)];
  }
  /// Bilinear, @p u and @p v in [0, 1].
  Eigen::Vector3d Skin(double u, double v) const { return Interpolate(skin, u, v); }
  Eigen::Vector3d Outer(double u, double v) const { return Interpolate(outer, u, v); }

 private:
  Eigen::Vector3d Interpolate(const std::vector<Eigen::Vector3d>& points, double u, double v) const;
};

HeadGrid BuildHeadGrid(const Subject& subject, const SkinSurface& surface, int columns, int rows);

/// How far [mm] a point of the skin (average coordinates) lies inside the hairy part of the head;
/// < 0 outside. The irregular edge that the texture shows is included when @p ragged.
double InsideHairline(const Subject& subject, const Eigen::Vector3d& p, bool ragged);

/// The same for the beard.
double InsideBeard(const Subject& subject, const Eigen::Vector3d& p);

/// Thickness [mm] of hair, cap or beard on the skin at @p p.
double HairThickness(const Subject& subject, const Eigen::Vector3d& p);

}  // namespace visavis
