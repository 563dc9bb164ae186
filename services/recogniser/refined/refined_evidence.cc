// RefinedEstimator: what it believes of a pose.
#include <algorithm>

#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr double kBeyond_rad = 0.1, kBeyond_m = 0.1;  ///< a head may leave the space by
constexpr double kBeyond = 0.08;                      ///< of its distance, likewise
constexpr double kPromisingInside = 0.4, kPromisingOutside = -0.15;

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

// What a face must show whoever it is. Where colours tell little, its features must tell more, and
// where they tell hardly anything, they must alone.
bool RefinedEstimator::IsFace(const Candidate& c) const {
  const EvidenceConfig& e = settings_.refined.evidence;
  if (!IsPlausible(c.refined.X_CM) || !c.refined.converged() || !BothEyes()) return false;
  const MeshScore& s = c.score;
  const auto shows = [&](double ncc, double stereo_ncc) {
    return s.ncc > ncc && c.refined.stereo_ncc > stereo_ncc;
  };
  if (shows(e.alone_ncc, e.alone_stereo_ncc) && s.outside < 0 && s.inside > 0) return true;
  if (!shows(e.lock_ncc, e.lock_stereo_ncc)) return false;
  return (s.outside < e.lock_outside && s.inside > e.lock_inside) ||
         (s.outside < e.vague_outside && s.inside > e.vague_inside && s.ncc > e.vague_ncc);
}

// What the face that was learned must show.
bool RefinedEstimator::IsKnownFace(const Candidate& c, double least_texture_ncc) const {
  return texture_.learned() && HasLooks(c, least_texture_ncc);
}

bool RefinedEstimator::IsKnownAgain(const Candidate& c) const {
  const EvidenceConfig& e = settings_.refined.evidence;
  return IsKnownFace(c, knows_enrolled() ? e.enrolled_texture_ncc : e.keep_texture_ncc);
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

// Its features speak for themselves: it is turned as the generic face is.
bool RefinedEstimator::IsClearFace(const Candidate& c) const {
  return IsFace(c) && c.score.ncc > settings_.refined.evidence.alone_ncc;
}

bool RefinedEstimator::IsHead(const Candidate& c) const {
  const EvidenceConfig& e = settings_.refined.evidence;
  return IsPlausible(c.refined.X_CM) && c.score.inside > e.lock_inside &&
         c.score.outside < e.lock_outside;
}

// All but the colours speak for a face, and they do not speak against it: they need more learning.
bool RefinedEstimator::IsPromising(const Candidate& c) const {
  const EvidenceConfig& e = settings_.refined.evidence;
  return IsPlausible(c.refined.X_CM) && BothEyes() && c.refined.stereo_ncc > e.lock_stereo_ncc &&
         c.score.ncc > e.lock_ncc && c.score.inside > kPromisingInside &&
         c.score.outside < kPromisingOutside;
}

}  // namespace visavis
