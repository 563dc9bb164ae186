// RefinedEstimator: what it believes of a pose.
#include <algorithm>
#include <cmath>

#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr double kBeyond_rad = 0.1, kBeyond_m = 0.1;       ///< a head may leave the space by
constexpr double kBeyond = 0.08;                           ///< of its distance, likewise
constexpr double kHeadInside = 0.3, kHeadOutside = -0.15;  ///< colours of a head
constexpr double kPromisingOdds = 1;
constexpr double kThere_m = 0.04, kThere_rad = 0.15;  ///< from where a face was seen last
constexpr double kElsewhereDoubt = 0.6;               ///< of the texture's fit, if all is hidden

}  // namespace

bool RefinedEstimator::IsPlausible(const RigidTransform& X_CM) const {
  if (!X_CM.matrix().allFinite()) return false;
  const Vector6d phi = PhiFromTransform(X_CM);
  const SearchSpace& space = population_.space();
  return ((phi - space.min).tail<3>().array() > -kBeyond_rad).all() &&
         ((space.max - phi).tail<3>().array() > -kBeyond_rad).all() &&
         phi[2] > space.min[2] - std::max(kBeyond_m, kBeyond * space.min[2]) &&
         phi[2] < space.max[2] + std::max(kBeyond_m, kBeyond * space.max[2]);
}

// scripts/train-head --odds: fitted to what searches found in pictures of 220 heads, in light from
// all sides, some before a wall like skin and some in grey: whether it was the face, within 12 mm
// and 8 deg, or something else.
double RefinedEstimator::Candidate::log_odds() const {
  const double agreement = std::pow(std::max(refined.stereo_ncc, 0.5), 8);
  const double log_odds = -9.4 + 19.1 * refined.likeness + 6.8 * agreement + 7.3 * score.inside -
                          1.0 * score.outside - 0.9 * refined.contour.rms_px();
  return std::isfinite(log_odds) ? log_odds : -1e9;
}

// What a face must show whoever it is.
bool RefinedEstimator::IsFace(const Candidate& c) const {
  return IsPlausible(c.refined.X_CM) && c.refined.converged() && BothEyes() &&
         c.refined.likeness > settings_.refined.evidence.lock_likeness &&
         c.log_odds() > settings_.refined.evidence.lock_log_odds;
}

// What the face that was learned must show.
bool RefinedEstimator::IsKnownFace(const Candidate& c, double least_texture_ncc) const {
  return texture_.learned() && HasLooks(c, least_texture_ncc);
}

// Where the face was seen last, something may have come before it. Elsewhere what does not fit
// speaks against the pose.
bool RefinedEstimator::IsKnownAgain(const Candidate& c) const {
  const EvidenceConfig& e = settings_.refined.evidence;
  const double least = knows_enrolled() ? e.enrolled_texture_ncc : e.keep_texture_ncc;
  const bool is_there =
      known_X_CM_ &&
      (c.refined.X_CM.translation() - known_X_CM_->translation()).norm() < kThere_m &&
      LogRotation(c.refined.X_CM.linear().transpose() * known_X_CM_->linear()).norm() < kThere_rad;
  return IsKnownFace(c, least + (is_there ? 0 : kElsewhereDoubt * c.refined.hidden));
}

bool RefinedEstimator::HasLooks(const Candidate& c, double least_texture_ncc) const {
  const EvidenceConfig& e = settings_.refined.evidence;
  return IsPlausible(c.refined.X_CM) && c.refined.converged() &&
         c.refined.texture_ncc > least_texture_ncc && c.score.ncc > e.keep_ncc &&
         (!BothEyes() || c.refined.stereo_ncc > e.keep_stereo_ncc);
}

// A face, but not as learned: it is another one, or the texture was wrong. Then it is learned anew.
bool RefinedEstimator::IsNewFace() {
  const bool is_face = IsFace(candidate_);
  if (is_face) ++strange_in_a_row_;
  if (!is_face && !is_aside_) strange_in_a_row_ = 0;
  if (!is_face) return false;
  if (texture_.learned() && strange_in_a_row_ < settings_.refined.evidence.strange_frames)
    return false;
  ForgetFace();
  return true;
}

void RefinedEstimator::Judge(bool good) {
  good_in_a_row_ = good ? good_in_a_row_ + 1 : 0;
  bad_in_a_row_ = good ? 0 : bad_in_a_row_ + 1;
  const EvidenceConfig& e = settings_.refined.evidence;
  TrackStatus& status = estimate_.status;
  if (status == TrackStatus::kTracking) {
    if (bad_in_a_row_ > 0) status = TrackStatus::kLost;
  } else if (good_in_a_row_ >= e.confirm_frames) {
    status = TrackStatus::kTracking;
  }
}

bool RefinedEstimator::IsClearFace(const Candidate& c) const {
  return IsFace(c) && c.log_odds() > settings_.refined.evidence.clear_log_odds;
}

bool RefinedEstimator::IsHead(const Candidate& c) const {
  return IsPlausible(c.refined.X_CM) && c.score.inside > kHeadInside &&
         c.score.outside < kHeadOutside;
}

// The colours may need more learning.
bool RefinedEstimator::IsPromising(const Candidate& c) const {
  return IsPlausible(c.refined.X_CM) && BothEyes() && c.log_odds() > kPromisingOdds;
}

}  // namespace visavis
