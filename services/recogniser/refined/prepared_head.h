#pragma once

#include "services/recogniser/refined/head_geometry.h"
#include "services/recogniser/refined/mesh_fitness.h"
#include "services/recogniser/refined/pose_refiner.h"

namespace visavis {

/// A head and all that is made of it before it is looked for. Stays where it is: others point into
/// it.
struct PreparedHead {
  PreparedHead(const RefinerConfig& config, const HeadGeometry& head);
  PreparedHead(const PreparedHead&) = delete;
  PreparedHead& operator=(const PreparedHead&) = delete;

  const HeadGeometry head;
  const HeadMesh mesh;
  const FacePoints face;
  const MeshFitness coarse_fitness, fitness;
  PoseRefiner refiner;
};

}  // namespace visavis
