#pragma once

#include <vector>

#include "common/geometry/rigid_transform.h"
#include "tests/people/head_scan.h"
#include "tests/people/trained_head.h"

namespace visavis {

/// A head that is aligned with the others.
struct AlignedHead {
  const HeadScan* scan;
  RigidTransform X_TM;
  double weight;  ///< of sum 1 over all
};

/// The mean head by direction, with its hair, and how the bare faces in front differ. Symmetric
/// about x = 0: each head counts as it is and mirrored.
ShapeModel TrainShape(const std::vector<AlignedHead>& heads);

}  // namespace visavis
