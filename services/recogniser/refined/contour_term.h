#pragma once

#include <cmath>
#include <vector>

#include "services/recogniser/refined/head_mesh.h"
#include "services/recogniser/refined/pose_equations.h"
#include "services/recogniser/refined/stereo_view.h"

namespace visavis {

/// How well the contours lay, for the judgement of a pose.
struct ContourFit {
  int count{0};          ///< contour points that measured
  double sum_square{0};  ///< of their distances [px^2], each capped at 25

  double rms_px() const { return count > 0 ? std::sqrt(sum_square / count) : 0; }
};

/// One place of the outline: the surface there should move so that slope . movement = distance.
struct OutlineMeasurement {
  Eigen::Vector3f p_M;
  Eigen::Vector3f slope;  ///< in C [px/m]
  float distance;         ///< outward [px]
  float weight;           ///< inverse variance
};

/// Silhouette and hairline against the colours along their normals: at each point of the model's
/// contour the place where inside turns to outside is found as a posterior over the pixels along
/// the normal (log-likelihood ratios summed up), with its mean and variance.
class ContourTerm {
 public:
  ContourTerm(const HeadMesh& mesh, const Hairline& hairline);

  /// Adds what @p eye measures of a head at @p pose. @param reach_px how far along the normals.
  void Add(const EyeView& eye, const EyePose& pose, int reach_px, float outline_weight,
           float hairline_weight, PoseEquations* equations, ContourFit* fit);

  /// The outline's measurements of the last Add().
  const std::vector<OutlineMeasurement>& outline() const { return outline_; }

 private:
  struct Candidate {
    Eigen::Vector3f p_M, n_M;
    HeadPart part;
    float weight, distance;  // distance < 0: none
  };
  static constexpr int kDirections = 96;
  static constexpr int kMaxReach = 16;
  enum class Edge { kHair, kSkin, kHairline };

  void FindSilhouette(const EyePose& pose);
  void Measure(const EyeView& eye, const EyePose& pose, const Eigen::Vector3f& p_M,
               const Eigen::Vector3f& n_M, Edge edge, int reach, float weight,
               PoseEquations* equations, ContourFit* fit);
  std::vector<OutlineMeasurement> outline_;

  HeadMesh mesh_;
  Hairline hairline_;
  std::vector<float> n_dot_p_, facing_;
  std::vector<Candidate> silhouette_;
};

}  // namespace visavis
