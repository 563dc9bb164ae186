// RefinedEstimator: what it learns from good frames.
#include <algorithm>
#include <cmath>
#include <utility>

#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr double kClearNcc = 0.8;     ///< of the texture: what was learned is seen in a frame
constexpr double kViewNcc = 0.6;      ///< likewise: a frame to learn a head from
constexpr double kFreeHidden = 0.25;  ///< share of the face, likewise
constexpr double kLeastDetail = 300;  ///< [px] to a metre, likewise

}  // namespace

void RefinedEstimator::LearnColors(const RigidTransform& X_CM) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (!view_[i].seen()) continue;
    const EyePose pose(pair().eye(i), X_CM);
    const EyeGeometry& g = pair().eye(i);
    const ImageView& picture = *pictures_[i];
    const Channels channels(picture.format);
    const PixelBox whole{0, 0, picture.width, picture.height};
    const PixelBox seen = pair().is_doubled() ? scores_[i].box() : whole;
    const auto bin = [&](const Eigen::Vector3f& p_M) {
      const Eigen::Vector3f p = pose.InEye(p_M);
      if (p.z() < 0.1f) return -1;
      const int u = static_cast<int>(std::lround(g.cx + g.fx * p.x() / p.z()));
      const int v = static_cast<int>(std::lround(g.cy + g.fy * p.y() / p.z()));
      if (u < seen.x0 || v < seen.y0 || u >= seen.x1 || v >= seen.y1) return -1;
      return ColorModel::BinOf(picture.row(v) + std::ptrdiff_t{channels.step} * u, channels);
    };
    counts_.Clear();
    for (std::size_t k = 0; k < head().mesh.vertices.size(); ++k) {
      const Eigen::Vector3f view = head().mesh.vertices[k] - pose.p_ME;
      const float facing = -head().mesh.normals[k].dot(view) / view.norm();
      if (facing > 0.3f && head().mesh.coloured[k]) {
        const int b = bin(head().mesh.vertices[k]);
        if (b >= 0)
          counts_.Add(head().mesh.parts[k] == HeadPart::kHair ? kHairColor : kSkinColor, b);
      } else if (std::abs(facing) < 0.2f && head().mesh.contour_weights[k] > 0) {
        for (const float beyond : {0.014f, 0.024f, 0.036f}) {
          const int b = bin(head().mesh.vertices[k] + beyond * head().mesh.normals[k]);
          if (b >= 0) counts_.Add(kSurroundings, b);
        }
      }
    }
    Random random(static_cast<std::uint64_t>(frames_));
    const ImageView& around = pair().is_doubled() ? pair().source(i) : picture;
    for (int k = 0; k < 300; ++k) {
      const int v = random.Index(around.height), u = random.Index(around.width);
      const std::uint8_t* pixel = around.row(v) + std::ptrdiff_t{channels.step} * u;
      counts_.Add(kSurroundings, ColorModel::BinOf(pixel, channels), 0.3f);
    }
    colors_[i].Learn(&counts_);
  }
}

void RefinedEstimator::Learn(const StereoFrame& frame) {
  if (frames_ % 2 == 0) LearnColors(candidate_.refined.X_CM);
  if (estimate_.status == TrackStatus::kTracking && !knows_enrolled() &&
      candidate_.refined.texture_ncc > kViewNcc && candidate_.refined.hidden < kFreeHidden &&
      pair().detail(X_CM_->translation().z()) > kLeastDetail)
    learner_.Add(frame, candidate_.refined.X_CM, colors_);
  if (estimate_.status != TrackStatus::kTracking) return;
  covariance_.Learn(TowardsCamera(candidate_.refined.X_CM));
  if (texture_.fixed()) return;
  for (const Band band : {kFineBand, kCoarseBand}) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (view_[i].seen())
        texture_.Learn(band,
                       head().refiner.Sample(view_, i, candidate_.refined.X_CM, band, texture_));
    }
  }
}

// A head learned from many views takes the place of the one that was tracked so far, where it is
// seen in this frame too.
void RefinedEstimator::TakeLearned() {
  if (!texture_.learned() || knows_enrolled() || !BothEyes()) return;
  HeadLearner::Learned learned = learner_.Step();
  if (!learned.head) return;
  if (!(learned.likeness >= settings_.refined.evidence.learned_likeness)) {
    ForgetFace();
    return;
  }
  FaceTexture texture(learned.head->face);
  texture.Remember(*learned.head->head.face);
  const Refined seen = learned.head->refiner.Refine(
      view_, *X_CM_ * learned.X_MN.inverse(), &texture, settings_.refined.search_iterations, 9);
  if (!seen.converged() || seen.texture_ncc < kClearNcc) return;
  texture_.Remember(*learned.head->head.face);
  learned_ = std::move(learned.head);
  ++learned_heads_;
  X_CM_ = seen.X_CM;
}

// The frame of a learned face goes where all views' generic models agree best.
void RefinedEstimator::MoveAnchor() {
  RigidTransform& X_CM = candidate_.refined.X_CM;
  anchor_.Add(TowardsCamera(X_CM), head().refiner.Generic(view_, X_CM));
  const RigidTransform X_MN = anchor_.Correct();
  X_CM = X_CM * X_MN;
  texture_.Move(X_MN.inverse());
}

}  // namespace visavis
