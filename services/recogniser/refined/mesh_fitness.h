#pragma once

#include <vector>

#include "services/recogniser/refined/face_points.h"
#include "services/recogniser/refined/head_mesh.h"
#include "services/recogniser/refined/stereo_view.h"

namespace visavis {

/// How well a pose explains the pictures; each a mean over the eyes.
struct MeshScore {
  double inside{0};   ///< colours on the head: about 1 where they are a head's
  double outside{0};  ///< colours round the head: about 1 where they are a head's too (bad)
  double ncc{0};      ///< correlation of the coarse band with the face's pattern, -1 to 1
  bool has_color{false}, has_ncc{false};
  /// What the search maximises.
  double total() const;
};

/// The fitness that the population is judged by: a solid model's inside, its surroundings (Eqs. 22
/// to 29 in spirit, with learned colours for fixed rules) and the features' pattern.
class MeshFitness {
 public:
  /// @p detail: what share of the mesh's and the face's points is looked at, one in so many.
  MeshFitness(const HeadMesh& mesh, const FacePoints& face, int detail);

  /// The face's pattern is the generic one's coarse band. No allocation.
  MeshScore Evaluate(const StereoView& view, const RigidTransform& X_CM) const;

  /// A glance at a few places of the face: mean skin score in units of 2 nats. Poses that fail it
  /// need no evaluation. 1 on grey pictures.
  double GlanceAtSkin(const StereoView& view, const RigidTransform& X_CM) const;

 private:
  struct Point {
    Eigen::Vector3f p, n;
    float n_dot_p;
    float value;  ///< pattern_: the generic face's brightness
    bool hair;    ///< inside_
  };
  double Inside(const EyeView& eye, const EyePose& pose) const;
  double Outside(const EyeView& eye, const EyePose& pose) const;
  double Correlation(const EyeView& eye, const EyePose& pose) const;
  static Point MakePoint(const Eigen::Vector3f& p, const Eigen::Vector3f& n);

  std::vector<Point> inside_, outline_, pattern_;
  std::vector<Eigen::Vector3f> skin_;  // a few points
};

}  // namespace visavis
