#pragma once

#include <cmath>
#include <vector>

#include "services/recogniser/refined/head_mesh.h"
#include "services/recogniser/refined/pose_equations.h"
#include "services/recogniser/refined/score_kernel.h"
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
/// the normal (log-likelihood ratios summed up), with its mean and variance. No allocation.
class ContourTerm {
 public:
  ContourTerm(const HeadMesh& mesh, const Hairline& hairline);

  /// Adds what @p eye measures of a head at @p pose. @param reach_px how far along the normals.
  void Add(const EyeView& eye, const EyePose& pose, int reach_px, float outline_weight,
           float hairline_weight, PoseEquations* equations, ContourFit* fit);

  /// What @p eye measures of the outline alone; valid until the next call.
  const std::vector<OutlineMeasurement>& MeasureOutline(const EyeView& eye, const EyePose& pose,
                                                        int reach_px);

 private:
  /// Where the silhouette passes a mesh edge.
  struct Candidate {
    Eigen::Vector3f p_M;
    float distance;  // < 0: none
    float t;         // how far from vertex a to b
    std::int32_t a, b;
  };
  static constexpr int kDirections = 96;

  void FindSilhouette(const KernelEye& eye, const EyePose& pose);
  void ReadEnds();
  void KeepOutermost();
  void Measure(const EyeView& eye, const KernelEye& kernel_eye, int reach, PoseEquations* equations,
               ContourFit* fit);

  HeadMesh mesh_;
  Hairline hairline_;
  OutlineVertices vertices_;
  std::vector<std::int32_t> first_edge_, edge_ends_;  // edges by their lower vertex
  std::vector<float> facing_, likelihoods_;
  std::vector<std::int32_t> near_;
  std::vector<Candidate> silhouette_;
  std::vector<OutlineMeasurement> outline_;
  Crossings crossings_;
  ContourPoints points_;
  EquationRows rows_;
};

}  // namespace visavis
