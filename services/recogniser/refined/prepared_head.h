#pragma once

#include "services/recogniser/refined/color_contrast.h"
#include "services/recogniser/refined/head_geometry.h"
#include "services/recogniser/refined/mesh_fitness.h"
#include "services/recogniser/refined/pose_refiner.h"

namespace visavis {

/// A head and what poses of it are refined with. Stays where it is: others point into it.
struct FacedHead {
  FacedHead(const RefinerConfig& config, const HeadGeometry& head);
  FacedHead(const FacedHead&) = delete;
  FacedHead& operator=(const FacedHead&) = delete;

  const HeadGeometry head;
  const HeadMesh mesh;
  const FacePoints face;
  PoseRefiner refiner;
};

/// All that is made of a head before it is looked for.
struct PreparedHead : FacedHead {
  PreparedHead(const RefinerConfig& config, const HeadGeometry& head);

  const MeshFitness shot_fitness, coarse_fitness, fitness;  ///< of few points, of many
  const ColorContrast contrast;

 private:
  PreparedHead(const RefinerConfig& config, const HeadGeometry& head, const HeadMesh& coarse_mesh);
};

}  // namespace visavis
