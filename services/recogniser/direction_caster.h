#pragma once

#include <vector>

#include "services/recogniser/joined_mesh.h"
#include "services/recogniser/refined/icosphere.h"

namespace visavis {

/// Where a ray from the origin meets a mesh.
struct DirectionHits {
  struct Hit {
    float radius{-1};  ///< [m]; < 0: none
    Label label{Label::kBackground};
  };
  Hit head, ear, neck;    ///< the outermost of each kind; head: neither ear nor neck
  float innermost{1e9f};  ///< of the head's hits
  float deepest_fold{0};  ///< [m] between innermost and outermost of the head's hits

  bool any() const { return head.radius > 0 || ear.radius > 0 || neck.radius > 0; }
  /// The head's, else the ear's, else the neck's; any() must hold.
  const Hit& outermost() const { return head.radius > 0 ? head : ear.radius > 0 ? ear : neck; }
};

/// One entry a vertex of @p sphere.
std::vector<DirectionHits> CastDirections(const JoinedMesh& mesh, const Icosphere& sphere);

}  // namespace visavis
