#include "services/recogniser/refined/prepared_head.h"

namespace visavis {
namespace {

constexpr int kMeshLevel = 4, kCoarseMeshLevel = 3;
constexpr double kFaceSpacing_m = 0.005;

}  // namespace

PreparedHead::PreparedHead(const RefinerConfig& config, const HeadGeometry& geometry)
    : head(geometry),
      mesh(MeshOf(head.surface, kMeshLevel)),
      face(FacePointsOf(head.surface, kFaceSpacing_m)),
      coarse_fitness(MeshOf(head.surface, kCoarseMeshLevel), face, 2),
      fitness(MeshOf(head.surface, kCoarseMeshLevel), face, 1),
      refiner(config, head.surface, mesh, face) {}

}  // namespace visavis
