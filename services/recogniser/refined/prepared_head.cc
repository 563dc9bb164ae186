#include "services/recogniser/refined/prepared_head.h"

namespace visavis {
namespace {

constexpr int kMeshLevel = 4, kCoarseMeshLevel = 3;
constexpr double kFaceSpacing_m = 0.005;

/// A shape found by bundling is least sure at its outline; a measured one is sure everywhere.
RefinerConfig WeightsFor(const HeadGeometry& head, RefinerConfig config) {
  if (head.is_measured) config.outline_weight_enrolled = config.outline_weight_with_texture;
  return config;
}

}  // namespace

FacedHead::FacedHead(const RefinerConfig& config, const HeadGeometry& geometry)
    : head(geometry),
      mesh(MeshOf(head.surface, kMeshLevel)),
      face(FacePointsOf(head.surface, kFaceSpacing_m)),
      refiner(WeightsFor(head, config), head.surface, mesh, face) {}

PreparedHead::PreparedHead(const RefinerConfig& config, const HeadGeometry& geometry)
    : PreparedHead(config, geometry, MeshOf(geometry.surface, kCoarseMeshLevel)) {}

PreparedHead::PreparedHead(const RefinerConfig& config, const HeadGeometry& geometry,
                           const HeadMesh& coarse_mesh)
    : FacedHead(config, geometry),
      shot_fitness(coarse_mesh, face, 6),
      coarse_fitness(coarse_mesh, face, 2),
      fitness(coarse_mesh, face, 1),
      contrast(coarse_mesh) {}

}  // namespace visavis
