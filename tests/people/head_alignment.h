#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "common/geometry/rigid_transform.h"

namespace visavis {

/// [m] from M's origin to a head's surface along a unit vector of M, given where M lies in the
/// head's own frame T; NaN where there is none.
using RadiusFunction =
    std::function<float(const RigidTransform& X_TM, const Eigen::Vector3f& direction)>;

/// Where the face is that heads are aligned by, and how far from M's origin, by direction.
struct FaceRegion {
  std::vector<Eigen::Vector3f> directions;
  Eigen::VectorXd radii_m;
};

/// Those directions of the icosphere of level 5 in which @p radius [m] is that of a point before
/// M's origin, from the forehead to the chin.
FaceRegion FaceRegionOf(const std::function<float(const Eigen::Vector3f& direction)>& radius);

/// Lays a head that is symmetric about x = 0 so that its radii are those of @p face, by moving M
/// along y and z and turning it about x: robust Gauss-Newton from @p X_TM.
RigidTransform AlignHead(const RadiusFunction& head, const FaceRegion& face,
                         const RigidTransform& X_TM);

/// One head of many.
struct HeadToAlign {
  RadiusFunction radius;
  RigidTransform X_TM;  ///< in: about where M is; out: where it is
  double weight{1};
};

/// Generalised Procrustes alignment: each head to the mean of all, which keeps its place in the
/// mean, again and again; then all together, so that the mean lies as @p face does.
void AlignHeads(const FaceRegion& face, std::vector<HeadToAlign>* heads);

}  // namespace visavis
