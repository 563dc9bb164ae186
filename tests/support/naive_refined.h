#pragma once

#include <array>
#include <vector>

#include "services/recogniser/refined/mesh_fitness.h"
#include "services/recogniser/refined/pose_refiner.h"

namespace visavis {

/// MeshFitness one point at a time in double precision.
class NaiveMeshFitness {
 public:
  NaiveMeshFitness(const HeadMesh& mesh, const FacePoints& face, int detail);

  MeshScore Evaluate(const StereoView& view, const RigidTransform& X_CM) const;
  /// Places that one evaluation projects into one eye.
  int num_points() const { return num_points_; }

 private:
  struct Point {
    Eigen::Vector3d p, n;
    double value;
    bool hair;
  };
  double Inside(const EyeView& eye, const RigidTransform& X_CM) const;
  double Outside(const EyeView& eye, const RigidTransform& X_CM) const;
  double Correlation(const EyeView& eye, const RigidTransform& X_CM) const;

  std::vector<Point> inside_, outline_, pattern_;
  int num_points_;
};

/// PoseRefiner::Generic one vertex, pixel and point at a time in double precision: the silhouette
/// from all edges of the mesh, with atan2 and exp.
class NaiveRefiner {
 public:
  NaiveRefiner(const RefinerConfig& config, const HeadSurface& surface, const HeadMesh& mesh,
               const FacePoints& face)
      : config_(config), hairline_(HairlineOf(surface, 33)), mesh_(mesh), face_(face) {}

  PoseEquations Generic(const StereoView& view, const RigidTransform& X_CM) const;

 private:
  void AddContours(const EyeView& eye, const RigidTransform& X_CM, int reach,
                   PoseEquations* equations) const;
  struct Samples;
  Samples SampleFace(const EyeView& eye, const RigidTransform& X_CM) const;
  /// All adults' looks, fitted to both eyes and eliminated.
  void AddLooks(const std::array<Samples, 2>& samples, const RigidTransform& X_CM,
                PoseEquations* equations) const;
  void AddStereo(const Samples& right, const Samples& left, const RigidTransform& X_CM,
                 PoseEquations* equations) const;

  RefinerConfig config_;
  Hairline hairline_;
  const HeadMesh& mesh_;
  const FacePoints& face_;
};

}  // namespace visavis
