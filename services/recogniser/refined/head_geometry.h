#pragma once

#include <Eigen/Core>
#include <optional>

#include "common/geometry/rigid_transform.h"
#include "services/recogniser/refined/adult_head.h"
#include "services/recogniser/refined/head_surface.h"
#include "services/recogniser/refined/learned_face.h"

namespace visavis {

/// The head that the refined estimator looks for. Its own frame M has the eyes where the generic
/// adult has them (HeadShape::eye_y): what the estimator knows about faces is laid out in it.
/// Poses are reported in the head's frame R, with M's axes and an origin of its own.
struct HeadGeometry {
  HeadSurface surface = TheAdult().surface;
  Eigen::Vector3d p_MR_m{0, 0, 0};  ///< R's origin in M
  /// How an enrolled face looks. Its frame is fixed then, by these points; without, it is learned.
  std::optional<LearnedFace> face{};
  /// Its surface is this very person's, measured: learning leaves it and its frame as they are.
  bool is_measured{false};
};

/// Where the camera is, seen from a head at @p X_CM: unit vector in M.
inline Eigen::Vector3d TowardsCamera(const RigidTransform& X_CM) {
  return -(X_CM.linear().transpose() * X_CM.translation()).normalized();
}

/// Between the pupils of the generic adult, on its surface: where every head has them in M [m].
Eigen::Vector3d AdultEyes();

/// The centre of an adult's cranium in M [m], about the middle of the heads that the generic one
/// was learned from: the R of heads that name no origin of their own (ChosenHead).
Eigen::Vector3d AdultOrigin();

/// @p surface by direction, for the level of so many vertices (see HeadTable); with the border of
/// its hair.
HeadTable TableOf(const HeadSurface& surface, int level);

}  // namespace visavis
