#pragma once

#include <array>

#include "common/config/rule.h"
#include "services/recogniser/refined/contour_term.h"
#include "services/recogniser/refined/face_texture.h"
#include "services/recogniser/refined/looks_fit.h"

namespace visavis {

/// Weights of what pulls a pose, and how far.
struct RefinerConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("outline_weight", &outline_weight, InRange(0.0, 10.0));
    a->Visit("outline_weight_with_texture", &outline_weight_with_texture, InRange(0.0, 10.0));
    a->Visit("outline_weight_enrolled", &outline_weight_enrolled, InRange(0.0, 10.0));
    a->Visit("hairline_weight", &hairline_weight, InRange(0.0, 10.0));
    a->Visit("pattern_weight", &pattern_weight, InRange(0.0, 10.0));
    a->Visit("texture_weight", &texture_weight, InRange(0.0, 10.0));
    a->Visit("stereo_weight", &stereo_weight, InRange(0.0, 10.0));
    a->Visit("stereo_weight_with_texture", &stereo_weight_with_texture, InRange(0.0, 10.0));
  }
  double outline_weight{1};
  double outline_weight_with_texture{0.5};
  double outline_weight_enrolled{0.1};  ///< or learned by bundling; not of a measured head
  double hairline_weight{0.15};         ///< relative to the outline's
  double pattern_weight{0.8};           ///< generic face
  double texture_weight{0.5};
  double stereo_weight{1};
  double stereo_weight_with_texture{1};
};

/// What a refinement found.
struct Refined {
  RigidTransform X_CM;
  Matrix6d information{Matrix6d::Zero()};  ///< of [dp; w] in C, from the last step's equations
  ContourFit contour;                      ///< both eyes
  double likeness{0};                      ///< of a face, whoever it is; see LooksFit
  double texture_ncc{0};                   ///< mean of the eyes; 0: not learned
  double stereo_ncc{0};                    ///< correlation of both eyes' views; 0: one eye
  double hidden{0};                        ///< share of the learned face behind something else
  double last_step_m{0}, last_step_rad{0};

  /// Whether it had come to rest: what still moves is on its way, not there.
  bool converged() const { return last_step_m < 0.004 && last_step_rad < 0.04; }
};

/// Gauss-Newton on a pose over contours, the generic face, the learned texture and the agreement of
/// both eyes.
class PoseRefiner {
 public:
  PoseRefiner(const RefinerConfig& config, const HeadSurface& surface, const HeadMesh& mesh,
              const FacePoints& face);

  /// @param texture   learned, or null: the generic face then.
  /// @param iterations  at most: a pose that has come to rest is left there.
  /// @param reach_px  of the first step's contours; later ones look nearer.
  Refined Refine(const StereoView& view, const RigidTransform& X_CM, const FaceTexture* texture,
                 int iterations, int reach_px);

  /// A few steps with the mean of all adults' faces, where Refine() fits which of them it is: for
  /// starts of which most lead nowhere.
  Refined RefineRoughly(const StereoView& view, const RigidTransform& X_CM, int reach_px);

  /// What the generic model alone says of the head at @p X_CM: equations of a correction [dp; w] in
  /// the M frame, X_CM' = X_CM [Exp(w), dp].
  PoseEquations Generic(const StereoView& view, const RigidTransform& X_CM);

  /// Where eye @p eye sees the outline of the head at @p X_CM.
  const std::vector<OutlineMeasurement>& Outline(const StereoView& view, std::size_t eye,
                                                 const RigidTransform& X_CM, int reach_px);

  /// Samples of the points of @p texture under @p X_CM, eye by eye, for learning: without what is
  /// hidden by something that the texture, once learned, does not show.
  const FaceSamples& Sample(const StereoView& view, std::size_t eye, const RigidTransform& X_CM,
                            Band band, const FaceTexture& texture);

 private:
  /// What is asked of the generic face in a step.
  enum class Looks { kMean, kMeanAndLikeness, kFitted };

  struct Steps {
    int iterations, reach_px;
    bool rough{false};
    bool hide{false};  ///< what does not look like the texture may be behind something
  };
  Refined Refine(const StereoView& view, const RigidTransform& X_CM, const FaceTexture* texture,
                 const Steps& steps);
  void AddGenericFace(const StereoView& view, const std::array<EyePose, 2>& poses, Band band,
                      Looks looks, double stereo_weight, PoseEquations* equations,
                      Refined* refined);
  void AddTexture(const StereoView& view, const std::array<EyePose, 2>& poses, Band band,
                  const FaceTexture& texture, bool hide, PoseEquations* equations,
                  Refined* refined);
  /// Both eyes see the same of @p plane at the points of @p face where they see @p sampled, the
  /// band that samples_ are of.
  void AddAgreement(const StereoView& view, const std::array<EyePose, 2>& poses,
                    const FacePoints& face, Band sampled, Band plane, double weight,
                    PoseEquations* equations);
  void AddContours(const StereoView& view, const std::array<EyePose, 2>& poses, int reach_px,
                   double weight, PoseEquations* equations, ContourFit* fit);

  RefinerConfig config_;
  const FacePoints& face_;
  LooksFit looks_;
  ContourTerm contours_;
  std::array<FaceSamples, 2> samples_, agreeing_;
};

}  // namespace visavis
