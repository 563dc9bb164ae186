#include "services/recogniser/refined/prepared_head.h"

namespace visavis {
namespace {

constexpr int kMeshLevel = 4, kCoarseMeshLevel = 3;
constexpr double kFaceSpacing_m = 0.005;

}  // namespace

FacedHead::FacedHead(const RefinerConfig& config, const HeadGeometry& geometry)
    : head(geometry),
      mesh(MeshOf(head.surface, kMeshLevel)),
      face(FacePointsOf(head.surface, kFaceSpacing_m)),
      refiner(config, head.surface, mesh, face) {}

PreparedHead::PreparedHead(const RefinerConfig& config, const HeadGeometry& geometry)
    : FacedHead(config, geometry),
      coarse_fitness(MeshOf(head.surface, kCoarseMeshLevel), face, 2),
      fitness(MeshOf(head.surface, kCoarseMeshLevel), face, 1),
      contrast(MeshOf(head.surface, kCoarseMeshLevel)) {}

}  // namespace visavis
