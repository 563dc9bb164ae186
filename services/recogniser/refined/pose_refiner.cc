#include "services/recogniser/refined/pose_refiner.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "services/recogniser/refined/occlusion.h"

namespace visavis {
namespace {

constexpr int kHairlinePoints = 33;
constexpr int kRoughIterations = 3;
constexpr int kMoreRounds = 2;
constexpr double kWellNcc = 0.92;     ///< of the texture: it fits, no more rounds
constexpr double kWholeNcc = 0.8;     ///< of the texture: nothing is before the face
constexpr double kHiddenDoubt = 0.3;  ///< the less is seen, the better it must fit
constexpr double kNearNcc = 0.75;     ///< of the texture's fine band: the pose is almost right
constexpr double kPrior_m = 0.025, kPrior_rad = 0.2;
constexpr double kAtRest_m = 0.0001, kAtRest_rad = 0.0005;  ///< steps so small change nothing
constexpr int kLastReachFrom = 2;  ///< iterations before look farther along the contours' normals
constexpr double kMaxStep_m = 0.025, kMaxStep_rad = 0.15;
constexpr float kPatternSigma = 1.0f, kTextureSigma = 0.45f;  ///< of the pattern's own contrast
// Cosine below which a face point is not looked at: the bands blur what is behind the head into
// those near the outline.
constexpr float kMinFacing = 0.6f;
// Of the face's contrast, that the eyes may differ by. On a shape that is only guessed brightness,
// which varies slowly, would turn the head: the fine band is asked there. On a learned shape bands
// err where skin is slanted or plain: brightness is asked.
constexpr float kFineStereoSigma = 0.35f, kBrightnessStereoSigma = 0.08f;
// One eye's depth comes from the learned face's size, which both eyes fixed, not from the outline.
constexpr double kOneEyeOutline = 0.05;
// Depth comes from both eyes: outlines take a large head for a near one.
constexpr double kAnchorStereo = 2;

std::array<EyePose, 2> PosesIn(const StereoView& view, const RigidTransform& X_CM) {
  return {EyePose(*view[0].geometry, X_CM), EyePose(*view[1].geometry, X_CM)};
}

/// Equations of a step in C about @p X_CM, told in M's axes.
PoseEquations InHead(const PoseEquations& in_C, const RigidTransform& X_CM) {
  Matrix6d R = Matrix6d::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = X_CM.linear();
  PoseEquations in_head;
  in_head.H = R.transpose() * in_C.Full() * R;
  in_head.g = R.transpose() * in_C.g;
  return in_head;
}

}  // namespace

PoseRefiner::PoseRefiner(const RefinerConfig& config, const HeadSurface& surface,
                         const HeadMesh& mesh, const FacePoints& face)
    : config_(config),
      face_(face),
      looks_(face),
      contours_(mesh, HairlineOf(surface, kHairlinePoints)),
      samples_{FaceSamples(face.size()), FaceSamples(face.size())},
      agreeing_{FaceSamples(face.size()), FaceSamples(face.size())} {}

const FaceSamples& PoseRefiner::Sample(const StereoView& view, std::size_t eye,
                                       const RigidTransform& X_CM, Band band,
                                       const FaceTexture& texture) {
  SampleFace(texture.points(), view[eye], EyePose(*view[eye].geometry, X_CM), band, kMinFacing,
             &samples_[eye]);
  if (texture.learned()) HideOccluded(texture, band, {&samples_[eye], nullptr});
  return samples_[eye];
}

const std::vector<OutlineMeasurement>& PoseRefiner::Outline(const StereoView& view, std::size_t eye,
                                                            const RigidTransform& X_CM,
                                                            int reach_px) {
  return contours_.MeasureOutline(view[eye], EyePose(*view[eye].geometry, X_CM), reach_px);
}

void PoseRefiner::AddContours(const StereoView& view, const std::array<EyePose, 2>& poses,
                              int reach_px, double weight, PoseEquations* equations,
                              ContourFit* fit) {
  if (weight <= 0) return;
  const auto outline = static_cast<float>(weight);
  const auto hairline = static_cast<float>(config_.hairline_weight * weight);
  for (std::size_t e = 0; e < 2; ++e) {
    if (view[e].seen())
      contours_.Add(view[e], poses[e], reach_px, outline, hairline, equations, fit);
  }
}

void PoseRefiner::AddGenericFace(const StereoView& view, const std::array<EyePose, 2>& poses,
                                 Band band, Looks looks, double stereo_weight,
                                 PoseEquations* equations, Refined* refined) {
  const auto weight = static_cast<float>(config_.pattern_weight);
  const bool is_fine = band == kFineBand;
  std::array<const FaceSamples*, 2> seen{};
  for (std::size_t e = 0; e < 2; ++e) {
    if (!view[e].seen()) continue;
    SampleFace(face_, view[e], poses[e], band, kMinFacing, &samples_[e]);
    seen[e] = &samples_[e];
    if (is_fine && looks == Looks::kFitted) continue;
    AddPattern(face_, samples_[e], poses[e].R_CM, face_.generic[band], face_.has_generic,
               kPatternSigma, weight, equations);
  }
  if (is_fine && looks != Looks::kMean) refined->likeness = looks_.Fit(seen);
  if (is_fine && looks == Looks::kFitted) looks_.AddTo(seen, poses[0].R_CM, weight, equations);
  if (seen[0] == nullptr || seen[1] == nullptr) return;
  refined->stereo_ncc = StereoCorrelation(samples_[0], samples_[1], face_.size());
  AddAgreement(view, poses, face_, band, kFineBand, stereo_weight, equations);
}

void PoseRefiner::AddAgreement(const StereoView& view, const std::array<EyePose, 2>& poses,
                               const FacePoints& face, Band sampled, Band plane, double weight,
                               PoseEquations* equations) {
  if (weight <= 0) return;
  if (plane != sampled) {
    for (std::size_t e = 0; e < 2; ++e) {
      SampleFace(face, view[e], poses[e], plane, kMinFacing, &agreeing_[e]);
      for (std::size_t i = 0; i < face.size(); ++i) agreeing_[e].seen[i] &= samples_[e].seen[i];
    }
  }
  const std::array<FaceSamples, 2>& eyes = plane == sampled ? samples_ : agreeing_;
  AddStereo(face, eyes[0], eyes[1], poses[0].R_CM,
            plane == kBrightness ? kBrightnessStereoSigma : kFineStereoSigma,
            static_cast<float>(weight), equations);
}

void PoseRefiner::AddTexture(const StereoView& view, const std::array<EyePose, 2>& poses, Band band,
                             const FaceTexture& texture, bool hide, PoseEquations* equations,
                             Refined* refined) {
  std::array<FaceSamples*, 2> seen{};
  for (std::size_t e = 0; e < 2; ++e) {
    if (!view[e].seen()) continue;
    SampleFace(texture.points(), view[e], poses[e], band, kMinFacing, &samples_[e]);
    seen[e] = &samples_[e];
  }
  const double hidden = hide ? HideOccluded(texture, band, seen) : 0;
  const auto add = [&](std::size_t e) {
    return AddPattern(texture.points(), samples_[e], poses[e].R_CM, texture.pattern(band),
                      texture.known(band), kTextureSigma,
                      static_cast<float>(config_.texture_weight), equations);
  };
  double sum = 0;
  int points = 0;
  for (std::size_t e = 0; e < 2; ++e) {
    if (seen[e] == nullptr) continue;
    const GainOffset fit =
        hidden > 0 ? FitPattern(samples_[e], texture.pattern(band), texture.known(band)) : add(e);
    sum += fit.count * fit.correlation;
    points += fit.count;
  }
  refined->texture_ncc = sum / std::max(points, 1) - kHiddenDoubt * hidden;
  refined->hidden = hidden;
  const bool both = seen[0] != nullptr && seen[1] != nullptr;
  if (both)
    refined->stereo_ncc = StereoCorrelation(samples_[0], samples_[1], texture.points().size());
  if (hidden > 0) {  // all that is left was judged, but only what is certain moves the pose
    KeepCertain(texture, band, seen);
    for (std::size_t e = 0; e < 2; ++e) {
      if (seen[e] != nullptr) add(e);
    }
  }
  if (both)
    AddAgreement(view, poses, texture.points(), band, texture.fixed() ? kBrightness : kFineBand,
                 config_.stereo_weight_with_texture, equations);
}

PoseEquations PoseRefiner::Generic(const StereoView& view, const RigidTransform& X_CM) {
  const std::array<EyePose, 2> poses = PosesIn(view, X_CM);
  PoseEquations equations;
  ContourFit ignored;
  Refined ignored_too;
  AddContours(view, poses, 6, config_.outline_weight, &equations, &ignored);
  AddGenericFace(view, poses, kFineBand, Looks::kFitted, kAnchorStereo * config_.stereo_weight,
                 &equations, &ignored_too);
  return InHead(equations, X_CM);
}

// What a pose that is not right yet leaves unexplained looks like something before the face: so the
// face is taken to be whole first.
Refined PoseRefiner::Refine(const StereoView& view, const RigidTransform& X_CM,
                            const FaceTexture* texture, int iterations, int reach_px) {
  Refined whole = Refine(view, X_CM, texture, Steps{iterations, reach_px});
  if (texture == nullptr) return whole;
  for (int k = 0; k < kMoreRounds && whole.texture_ncc < kWellNcc; ++k)
    whole = Refine(view, whole.X_CM, texture, Steps{iterations, reach_px});
  if (whole.texture_ncc > kWholeNcc) return whole;
  const Refined hidden = Refine(view, X_CM, texture, {iterations, reach_px, false, true});
  return hidden.texture_ncc > whole.texture_ncc ? hidden : whole;
}

Refined PoseRefiner::RefineRoughly(const StereoView& view, const RigidTransform& X_CM,
                                   int reach_px) {
  return Refine(view, X_CM, nullptr, {kRoughIterations, reach_px, true, false});
}

Refined PoseRefiner::Refine(const StereoView& view, const RigidTransform& X_CM,
                            const FaceTexture* texture, const Steps& steps) {
  const auto& [iterations, reach_px, rough, hide] = steps;
  Refined refined;
  refined.X_CM = X_CM;
  bool near = false;  // so much that the coarse band, which sees less, would only lead astray
  for (int i = 0; i < iterations; ++i) {
    PoseEquations equations;
    equations.AddPrior(kPrior_m, kPrior_rad);
    refined.contour = {};
    const std::array<EyePose, 2> poses = PosesIn(view, refined.X_CM);
    const int reach = i == 0 ? reach_px : i < kLastReachFrom ? std::min(reach_px, 6) : 4;
    const Band band = i < iterations / 2 && !near ? kCoarseBand : kFineBand;
    if (texture != nullptr) {
      const bool both = view[0].seen() && view[1].seen();
      const double outline =
          texture->fixed() ? config_.outline_weight_enrolled : config_.outline_weight_with_texture;
      AddContours(view, poses, reach, (both ? 1 : kOneEyeOutline) * outline, &equations,
                  &refined.contour);
      if (i == 0) {
        PoseEquations fine = equations;
        AddTexture(view, poses, kFineBand, *texture, hide, &fine, &refined);
        near = refined.texture_ncc > kNearNcc;
        if (near) equations = fine;
      }
      if (i > 0 || !near) AddTexture(view, poses, band, *texture, hide, &equations, &refined);
    } else {
      AddContours(view, poses, reach, config_.outline_weight, &equations, &refined.contour);
      const Looks looks = !rough                ? Looks::kFitted
                          : i + 1 == iterations ? Looks::kMeanAndLikeness
                                                : Looks::kMean;
      AddGenericFace(view, poses, band, looks, config_.stereo_weight, &equations, &refined);
    }
    refined.information = equations.Full();
    Vector6d step = refined.information.ldlt().solve(equations.g);
    if (!step.allFinite()) break;
    const double way = step.head<3>().norm(), turn = step.tail<3>().norm();
    if (way > kMaxStep_m) step.head<3>() *= kMaxStep_m / way;
    if (turn > kMaxStep_rad) step.tail<3>() *= kMaxStep_rad / turn;
    refined.X_CM = Moved(refined.X_CM, step);
    refined.last_step_m = way;
    refined.last_step_rad = turn;
    if (way > kAtRest_m || turn > kAtRest_rad || i < kLastReachFrom) continue;
    if (band == kFineBand) break;
    i = std::max(i, iterations / 2 - 1);  // on to the fine band
  }
  return refined;
}

}  // namespace visavis
