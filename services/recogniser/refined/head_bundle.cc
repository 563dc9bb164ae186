#include "services/recogniser/refined/head_bundle.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/check.h"
#include "services/recogniser/refined/head_anchor.h"

namespace visavis {
namespace {

constexpr int kShapeLevel = 4;
constexpr int kFewestPoints = 40;  ///< that a gain is fitted to
constexpr int kIterations = 6, kReach_px = 6, kOutlineReach_px = 10;
constexpr int kTextureSteps = 2;  ///< of a whole texture, a round
constexpr int kRadiusSteps = 4;   ///< of a fixed point iteration
constexpr float kMinFacing = 0.6f;
// What the modes of adults' faces leave of a shape, where they tell of it and elsewhere.
constexpr double kOwn_m = 0.001, kOwnRoughness_m = 0.0002;
constexpr double kOutside_m = 0.010, kOutsideRoughness_m = 0.0008;
/// Neighbouring points and both bands see the same noise and the same errors.
constexpr double kIndependence = 0.05, kOutlineIndependence = 0.3;
constexpr float kStereoFacing = 0.75f;
constexpr double kStereoIndependence = 1;
/// What the eyes differ by, of the contrast.
constexpr float kFineStereoSigma = 0.25f, kBrightnessStereoSigma = 0.06f;
constexpr float kRelativeSigma = 0.35f, kNoise = 0.5f;  ///< as in the refiner: contrast, levels

PixelBox Common(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

ShapeEquations::Prior PriorOf(const ShapeEquations& shape) {
  ShapeEquations::Prior prior = shape.UniformPrior(kOwn_m, kOwnRoughness_m);
  prior.modes_m = TheAdult().shape_modes_m;
  VISAVIS_THROW_UNLESS(prior.modes_m.rows() == prior.displacement_m.size(), prior.modes_m.rows());
  for (Eigen::Index i = 0; i < prior.modes_m.rows(); ++i) {
    if (!prior.modes_m.row(i).isZero()) continue;
    prior.displacement_m[i] = kOutside_m;
    prior.roughness_m[i] = kOutsideRoughness_m;
  }
  return prior;
}

/// Inverse variance of a measurement that is off by @p residual, where @p sigma is expected.
double Robust(float residual, float sigma) {
  return 1 / static_cast<double>(sigma * sigma + residual * residual / 4);
}

}  // namespace

HeadView ViewOf(const StereoFrame& frame, const RigidTransform& X_CM, double radius_m,
                WorkingPair* pair) {
  HeadView view;
  view.X_CM = X_CM;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto picture = pair->Picture(frame, i);
    VISAVIS_THROW_UNLESS(picture.has_value(), i);
    HeadView::Crop& crop = view.crops[i];
    crop.box = pair->BoxAround(i, X_CM, radius_m);
    crop.format = picture->format;
    const std::ptrdiff_t channels = BytesPerPixel(crop.format);
    for (int y = crop.box.y0; y < crop.box.y1; ++y) {
      const std::uint8_t* row = picture->row(y);
      crop.pixels.insert(crop.pixels.end(), row + channels * crop.box.x0,
                         row + channels * crop.box.x1);
    }
  }
  return view;
}

HeadBundle::HeadBundle(const RefinerConfig& config, const StereoRig& rig, double distance_m,
                       const HeadGeometry& head, const std::array<ColorModel, 2>& colors,
                       Band compared)
    : config_(config),
      start_(head),
      compared_(compared),
      start_table_(TableOf(head.surface, kShapeLevel)),
      pair_(rig, distance_m),
      colors_(colors),
      scores_{ScoreMap(pair_.eye(0).width, pair_.eye(0).height),
              ScoreMap(pair_.eye(1).width, pair_.eye(1).height)},
      bands_{BandImages(pair_.eye(0).width, pair_.eye(0).height),
             BandImages(pair_.eye(1).width, pair_.eye(1).height)},
      shape_(kShapeLevel),
      prior_(PriorOf(shape_)),
      displaced_(start_table_.radii_m.size()),
      model_(std::make_unique<Model>(config, head)) {}

ImageView HeadBundle::Unfold(const HeadView::Crop& crop, std::size_t eye) {
  const EyeGeometry& geometry = pair_.eye(eye);
  const int channels = BytesPerPixel(crop.format);
  std::vector<std::uint8_t>& pixels = unfolded_[eye];
  pixels.resize(static_cast<std::size_t>(geometry.width) *
                static_cast<std::size_t>(geometry.height) * static_cast<std::size_t>(channels));
  ImageView picture{pixels.data(), geometry.width, geometry.height, channels * geometry.width,
                    pixels.size(), crop.format};
  const std::ptrdiff_t row_size = std::ptrdiff_t{channels} * crop.box.width();
  auto from = crop.pixels.begin();
  for (int y = crop.box.y0; y < crop.box.y1; ++y, from += row_size) {
    std::copy(from, from + row_size,
              pixels.begin() + std::ptrdiff_t{y} * picture.stride +
                  std::ptrdiff_t{channels} * crop.box.x0);
  }
  return picture;
}

void HeadBundle::Look(const HeadView& view, bool at_colors) {
  for (std::size_t i = 0; i < 2; ++i) {
    const HeadView::Crop& crop = view.crops[i];
    const PixelBox box = Common(pair_.BoxAround(i, view.X_CM, kHeadRadius_m), crop.box);
    view_[i] = {&pair_.eye(i), nullptr, nullptr};
    if (box.width() < kLeastBox_px || box.height() < kLeastBox_px) continue;
    const ImageView picture = Unfold(crop, i);
    if (at_colors) scores_[i].Build(picture, colors_[i], box);
    bands_[i].Build(picture, box);
    view_[i] = {&pair_.eye(i), at_colors ? &scores_[i] : nullptr, &bands_[i]};
  }
}

void HeadBundle::LearnTexture() {
  FaceTexture& texture = model_->texture;
  texture.Forget();
  for (const HeadView& view : views_) {
    Look(view, false);
    for (const Band band : {kFineBand, kCoarseBand}) {
      for (std::size_t eye = 0; eye < 2; ++eye) {
        if (!view_[eye].seen()) continue;
        texture.Learn(band, model_->faced.refiner.Sample(view_, eye, view.X_CM, band, texture));
      }
    }
  }
}

HeadGeometry HeadBundle::Enrolled() {
  LearnTexture();
  HeadGeometry head = model_->faced.head;
  head.face = model_->texture.Learned();
  return head;
}

HeadBundle::Agreement HeadBundle::RefinePoses() {
  Agreement sum;
  for (HeadView& view : views_) {
    Look(view, true);
    const Refined refined =
        model_->faced.refiner.Refine(view_, view.X_CM, &model_->texture, kIterations, kReach_px);
    if (refined.X_CM.matrix().allFinite()) view.X_CM = refined.X_CM;
    const double share = 1 / static_cast<double>(views_.size());
    sum.texture_ncc += share * refined.texture_ncc;
    sum.stereo_ncc += share * refined.stereo_ncc;
    sum.contour_px += share * refined.contour.rms_px();
  }
  return sum;
}

// A surface point that moves by m along its direction d from M's origin changes what an eye sees
// there by slope . R_CM d m.
void HeadBundle::AddShape(const HeadView& view, Band band) {
  const FacePoints& points = model_->texture.points();
  const std::vector<float>& pattern = model_->texture.pattern(band);
  const Eigen::Matrix3f R_CM = view.X_CM.linear().cast<float>();
  FaceSamples s(points.size());
  for (std::size_t eye = 0; eye < 2; ++eye) {
    if (!view_[eye].seen()) continue;
    SampleFace(points, view_[eye], EyePose(pair_.eye(eye), view.X_CM), band, kMinFacing, &s);
    const GainOffset fit = FitPattern(s, pattern, model_->texture.known(band));
    if (fit.count < kFewestPoints || !(fit.gain > 0)) continue;
    const auto gain = static_cast<float>(fit.gain), offset = static_cast<float>(fit.offset);
    const float sigma = kRelativeSigma * gain * static_cast<float>(fit.pattern_rms) + kNoise;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!s.seen[i] || !model_->texture.known(band)[i]) continue;
      const Eigen::Vector3f d = points.points[i].normalized();
      const float residual = gain * pattern[i] + offset - s.value[i];
      shape_.Add(d, static_cast<double>(s.slope[i].dot(R_CM * d)), static_cast<double>(residual),
                 kIndependence * Robust(residual, sigma));
    }
  }
}

// Within a pair both eyes see the same light on the head.
void HeadBundle::AddStereoShape(const HeadView& view) {
  if (!view_[0].seen() || !view_[1].seen()) return;
  const FacePoints& points = model_->texture.points();
  const Eigen::Matrix3f R_CM = view.X_CM.linear().cast<float>();
  FaceSamples right(points.size()), left(points.size());
  for (const std::size_t eye : {0, 1})
    SampleFace(points, view_[eye], EyePose(pair_.eye(eye), view.X_CM), compared_, kStereoFacing,
               eye == 0 ? &right : &left);
  const GainOffset fit = FitEyes(right, left, points.size());
  if (fit.count < kFewestPoints) return;
  const auto gain = static_cast<float>(fit.gain), offset = static_cast<float>(fit.offset);
  const float relative_sigma = compared_ == kBrightness ? kBrightnessStereoSigma : kFineStereoSigma;
  const float sigma = relative_sigma * static_cast<float>(fit.pattern_rms) + kNoise;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!right.seen[i] || !left.seen[i]) continue;
    const Eigen::Vector3f d = points.points[i].normalized();
    const float residual = gain * left.value[i] + offset - right.value[i];
    const Eigen::Vector3f slope = right.slope[i] - gain * left.slope[i];
    shape_.Add(d, static_cast<double>(slope.dot(R_CM * d)), static_cast<double>(residual),
               kStereoIndependence * Robust(residual, sigma));
  }
}

void HeadBundle::AddOutline(const HeadView& view) {
  const Eigen::Matrix3f R_CM = view.X_CM.linear().cast<float>();
  for (std::size_t eye = 0; eye < 2; ++eye) {
    if (!view_[eye].seen()) continue;
    for (const OutlineMeasurement& m :
         model_->faced.refiner.Outline(view_, eye, view.X_CM, kOutlineReach_px)) {
      const Eigen::Vector3f d = m.p_M.normalized();
      shape_.Add(d, static_cast<double>(m.slope.dot(R_CM * d)), static_cast<double>(m.distance),
                 kOutlineIndependence * static_cast<double>(m.weight));
    }
  }
}

double HeadBundle::MoveSurface() {
  const std::vector<float> movement = shape_.Solve(displaced_, prior_);
  double sum = 0;
  for (std::size_t i = 0; i < displaced_.size(); ++i) {
    displaced_[i] += movement[i];
    sum += static_cast<double>(movement[i] * movement[i]);
  }
  RebuildModel();
  return std::sqrt(sum / static_cast<double>(movement.size()));
}

void HeadBundle::RebuildModel() {
  HeadTable table = start_table_;
  for (std::size_t i = 0; i < displaced_.size(); ++i) table.radii_m[i] += displaced_[i];
  model_.reset();  // not two at once
  model_ = std::make_unique<Model>(config_, HeadGeometry{HeadSurface(start_.surface.shape(), table),
                                                         start_.p_MR_m, std::nullopt});
}

// What no texture that is learned under the poses can tell: as for a face that is learned on the
// way.
double HeadBundle::MoveTexture() {
  double moved_m = 0;
  for (int k = 0; k < kTextureSteps; ++k) {
    HeadAnchor anchor;
    for (const HeadView& view : views_) {
      Look(view, true);
      anchor.Add(TowardsCamera(view.X_CM), model_->faced.refiner.Generic(view_, view.X_CM));
    }
    const RigidTransform X_MN = anchor.Correct();
    for (HeadView& view : views_) view.X_CM = view.X_CM * X_MN;
    moved_m += X_MN.translation().norm();
  }
  return moved_m;
}

void HeadBundle::Rebase() {
  for (std::size_t i = 0; i < displaced_.size(); ++i) start_table_.radii_m[i] += displaced_[i];
  std::fill(displaced_.begin(), displaced_.end(), 0.0f);
}

void HeadBundle::MoveFrame(const RigidTransform& X_MN) {
  VISAVIS_THROW_UNLESS(!start_.is_measured, views_.size());
  const RigidTransform X_NM = X_MN.inverse();
  for (HeadView& view : views_) view.X_CM = view.X_CM * X_NM;
  const HeadSurface& surface_N = model_->faced.head.surface;
  const std::vector<Eigen::Vector3f>& directions = shape_.sphere().vertices();
  const Eigen::Isometry3f X(X_NM.matrix().cast<float>());
  for (std::size_t i = 0; i < displaced_.size(); ++i) {
    float radius = start_table_.radii_m[i] + displaced_[i];
    for (int k = 0; k < kRadiusSteps; ++k) {
      const Eigen::Vector3f p_N = X * (radius * directions[i]);
      radius -= p_N.norm() - surface_N.Radius(p_N.normalized());
    }
    displaced_[i] = radius - start_table_.radii_m[i];
  }
  RebuildModel();
}

HeadBundle::Agreement HeadBundle::Round() {
  LearnTexture();
  Agreement agreement = RefinePoses();
  if (start_.is_measured) {
    agreement.moved_m = MoveTexture();
    return agreement;
  }
  LearnTexture();
  shape_.Clear();
  for (const HeadView& view : views_) {
    Look(view, true);
    for (const Band band : {kFineBand, kCoarseBand}) AddShape(view, band);
    AddStereoShape(view);
    AddOutline(view);
  }
  agreement.moved_m = MoveSurface();
  return agreement;
}

}  // namespace visavis
