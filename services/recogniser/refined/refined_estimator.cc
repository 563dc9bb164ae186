#include "services/recogniser/refined/refined_estimator.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

constexpr int kEnrolledEvery = 5;  ///< frames: a stranger is looked at for the enrolled face
constexpr int kStrangerGone = 3;   ///< frames without
constexpr int kMoreRounds = 2;     ///< of iterations, where a tracked pose has not come to rest

/// What a head that is learned begins with: once a face is enrolled, that of somebody else.
HeadGeometry ToLearnFrom(HeadGeometry head) {
  if (head.face) head.is_measured = false;
  return head;
}

}  // namespace

RefinedEstimator::RefinedEstimator(const RefinedSettings& settings, const HeadGeometry& head,
                                   const StereoRig& rig, Background* background)
    : settings_(settings),
      head_(settings.refined.refiner, head),
      X_MR_(MakeTransform(Eigen::Matrix3d::Identity(), head.p_MR_m)),
      rig_(rig),
      ranges_(rig, InM(settings.space)),
      texture_(head_.face),
      learner_(settings.refined.refiner, rig, settings.space.distance(), ToLearnFrom(head),
               settings.refined.learned_views, background),
      scores_{ScoreMap(ranges_.width(), ranges_.height()),
              ScoreMap(ranges_.width(), ranges_.height())},
      bands_{BandImages(ranges_.width(), ranges_.height()),
             BandImages(ranges_.width(), ranges_.height())},
      population_(settings.refined.population, settings.seed) {
  settings_.space = InM(settings.space);
  if (head.face) {
    enrolled_.emplace(head_.face);
    enrolled_->Remember(*head.face);
  }
  Reset();
}

void RefinedEstimator::Reset() {
  ForgetFace();
  RememberEnrolled();
  for (ColorModel& colors : colors_) colors.Reset();
  centre_.reset();
  population_ = RealPopulation(settings_.refined.population, settings_.seed);
  color_channels_ = {};
  frames_ = 0;
  good_in_a_row_ = bad_in_a_row_ = one_eye_in_a_row_ = 0;
  X_CM_.reset();
  if (settings_.start_X_CM) X_CM_ = *settings_.start_X_CM * X_MR_.inverse();
  searched_range_ = FirstRange();
  WorkIn(searched_range_);
  population_.SetSpace(ranges_.space(range_));
  population_.Restart();
  estimate_ = Estimate{};
  rejected_.clear();
}

void RefinedEstimator::ForgetFace() {
  texture_.Forget();
  learned_.reset();
  learner_.Forget();
  anchor_.Forget();
  covariance_.Forget();
  known_X_CM_.reset();
  strange_in_a_row_ = 0;
  is_aside_ = false;
}

void RefinedEstimator::RememberEnrolled() {
  if (!enrolled_ || knows_enrolled()) return;
  ForgetFace();
  texture_.Remember(*head_.head.face);
}

void RefinedEstimator::LookForEnrolled() {
  if (!enrolled_ || knows_enrolled() || frames_ % kEnrolledEvery != 0) return;
  const Candidate known =
      RefineFrom(candidate_.refined.X_CM, &*enrolled_, settings_.refined.search_iterations, 7);
  if (!HasLooks(known, settings_.refined.evidence.enrolled_texture_ncc)) return;
  RememberEnrolled();
  candidate_ = known;
}

void RefinedEstimator::SetSearchSpace(const SearchSpace& space) {
  DistanceRanges ranges(rig_, InM(space));
  settings_.space = InM(space);
  ranges_ = std::move(ranges);
  scores_.fill(ScoreMap(ranges_.width(), ranges_.height()));
  bands_.fill(BandImages(ranges_.width(), ranges_.height()));
  centre_.reset();
  searched_range_ = FirstRange();
  WorkIn(searched_range_);
  population_.SetSpace(ranges_.space(range_));
}

void RefinedEstimator::WorkIn(std::size_t range) {
  range_ = range;
  learner_.SetDistance(ranges_.space(range).distance());
}

std::size_t RefinedEstimator::FirstRange() const {
  return X_CM_ && bad_in_a_row_ == 0 ? ranges_.At(X_CM_->translation().z()) : 0;
}

SearchSpace RefinedEstimator::InM(SearchSpace space) const {
  space.min.head<3>() -= X_MR_.translation();
  space.max.head<3>() -= X_MR_.translation();
  return space;
}

int RefinedEstimator::Lowered(int count, double share, int least) {
  const double lowered = std::round(share * static_cast<double>(count));
  return std::max(std::min(count, least), static_cast<int>(lowered));
}

void RefinedEstimator::CentreOn(const Eigen::Vector3d& p_CM) {
  WorkIn(ranges_.At(p_CM.z(), range_));
  if (!settings_.recentre) {
    population_.SetSpace(ranges_.space(range_));
    return;
  }
  centre_ = p_CM;
  is_centred_ = true;
  population_.SetSpace(ranges_.space(range_).CentredOn(p_CM));
}

void RefinedEstimator::LookInto(std::size_t range) {
  if (range != range_) {
    WorkIn(range);
    population_.SetSpace(ranges_.space(range));
    population_.Restart();
  }
  pair().LookAt(population_.space().middle().head<3>());
  TakePictures();
}

void RefinedEstimator::TakePictures() {
  for (std::size_t i = 0; i < 2; ++i) {
    pictures_[i] = pair().Picture(*frame_, i);
    if (!pictures_[i] || color_channels_[i] == BytesPerPixel(pictures_[i]->format)) continue;
    if (pair().is_doubled()) pair().Fill(i, pair().WholeBox(i));
    colors_[i].StartFrom(*pictures_[i]);
    if (color_channels_[i] != 0) learner_.Forget();  // its views are of the other kind
    color_channels_[i] = BytesPerPixel(pictures_[i]->format);
  }
}

void RefinedEstimator::BuildMaps(const RigidTransform* X_CM) {
  for (std::size_t i = 0; i < 2; ++i) {
    view_[i] = {&pair().eye(i), nullptr, nullptr};
    if (!pictures_[i]) continue;
    const PixelBox box = X_CM ? pair().BoxAround(i, *X_CM, kHeadRadius_m) : pair().WholeBox(i);
    if (box.width() < kLeastBox_px || box.height() < kLeastBox_px) continue;
    pair().Fill(i, box);
    scores_[i].Build(*pictures_[i], colors_[i], box);
    bands_[i].Build(*pictures_[i], box);
    view_[i].scores = &scores_[i];
    view_[i].bands = &bands_[i];
  }
}

bool RefinedEstimator::IsMapped(const RigidTransform& X_CM) const {
  for (std::size_t i = 0; i < 2; ++i) {
    if (view_[i].seen() && !scores_[i].box().Contains(pair().BoxAround(i, X_CM, kFaceRadius_m)))
      return false;
  }
  return true;
}

// Fig. 3: the pose and all individuals are moved against the camera's motion.
void RefinedEstimator::Feedforward(const CameraStep& step) {
  estimate_.feedforward = FeedforwardMode::kNone;
  if (!step.known || settings_.feedforward == FeedforwardMode::kNone) return;
  estimate_.feedforward = settings_.feedforward;
  const auto move = [&](Vector6d* phi) {
    *phi = settings_.feedforward == FeedforwardMode::kExact
               ? Carry(step.X_C2C1, *phi)
               : EulerStep(*phi, step.X_WC1.linear(), step.twist_1, step.dt_s);
  };
  population_.Move(move);
  for (Eigen::Vector3d& p_CM : rejected_) p_CM = step.X_C2C1 * p_CM;
  if (centre_) {
    centre_ = step.X_C2C1 * *centre_;
    if (is_centred_) CentreOn(*centre_);
  }
  for (std::optional<RigidTransform>* X : {&X_CM_, &known_X_CM_}) {
    if (!X->has_value()) continue;
    Vector6d phi = PhiFromTransform(**X);
    move(&phi);
    *X = TransformFromPhi(phi);
  }
}

RefinedEstimator::Candidate RefinedEstimator::RefineFrom(const RigidTransform& X_CM,
                                                         const FaceTexture* texture, int iterations,
                                                         int reach_px) {
  return Scored(head().refiner.Refine(view_, X_CM, texture, iterations, reach_px));
}

RefinedEstimator::Candidate RefinedEstimator::Scored(const Refined& refined) const {
  return {refined, head().fitness.Evaluate(view_, refined.X_CM)};
}

RefinedEstimator::Candidate RefinedEstimator::Track() {
  const FaceTexture* texture = texture_.learned() ? &texture_ : nullptr;
  Candidate best = RefineFrom(*X_CM_, texture, settings_.refined.iterations, 9);
  for (int k = 0; k < kMoreRounds && !best.refined.converged(); ++k) {
    best = RefineFrom(best.refined.X_CM, texture, settings_.refined.iterations, 9);
  }
  estimate_.evaluations += 1;
  const auto fitness = [&](const Vector6d& phi) {
    ++estimate_.evaluations;
    return head().coarse_fitness.Evaluate(view_, TransformFromPhi(phi)).total();
  };
  if (settings_.refined.track_evaluations == 0) return best;
  const int one_generation = settings_.refined.population.individuals + 2;
  const int evaluations =
      Lowered(settings_.refined.track_evaluations, effort_.tracking, one_generation);
  population_.Evaluate(fitness);
  while (estimate_.evaluations < evaluations) {
    population_.Reproduce(fitness);
    ++estimate_.generations;
  }
  const RigidTransform X_elite = TransformFromPhi(population_.best().phi);
  const double distance = (X_elite.translation() - best.refined.X_CM.translation()).norm();
  if (distance > 0.015 && population_.best().fitness > best.score.total() + 0.1) {
    const Candidate other = RefineFrom(X_elite, texture, settings_.refined.iterations, 9);
    const bool better = texture != nullptr
                            ? other.refined.texture_ncc > best.refined.texture_ncc + 0.05
                            : other.score.total() > best.score.total() + 0.05;
    if (better) best = other;
  }
  const Vector6d phi = PhiFromTransform(best.refined.X_CM);
  population_.Insert(phi, fitness(phi));
  return best;
}

// A part of a face can look like another: all of it must be looked at.
RefinedEstimator::Candidate RefinedEstimator::Follow() {
  const Candidate found = Track();
  if (!IsPlausible(found.refined.X_CM) || IsMapped(found.refined.X_CM)) return found;
  X_CM_ = found.refined.X_CM;
  BuildMaps(&*X_CM_);
  return Track();
}

std::optional<RefinedEstimator::Candidate> RefinedEstimator::WhereLost() {
  if (!known_X_CM_ || !texture_.learned()) return {};
  if (ranges_.At(known_X_CM_->translation().z(), range_) != range_) return {};
  const Candidate known =
      RefineFrom(*known_X_CM_, &texture_, settings_.refined.search_iterations, 9);
  if (!IsKnownAgain(known)) return {};
  return known;
}

// The search space moves with a tracked head; a lost one is looked for where the configuration puts
// it and round its last place by turns.
void RefinedEstimator::FollowHead() {
  if (estimate_.status == TrackStatus::kTracking || bad_in_a_row_ == 0) {
    CentreOn(X_CM_->translation());
    searched_range_ = (range_ + ranges_.size() - 1) % ranges_.size();  // its own comes next
    is_aside_ = false;
    return;
  }
  // Where a stranger was seen is looked at again, and by turns round the last place: it may be the
  // learned face, seen wrongly.
  const bool stays = strange_in_a_row_ > 0;
  if (strange_in_a_row_ == 1 && !is_aside_) is_stranger_centred_ = is_centred_;
  const bool is_centre_here = centre_ && ranges_.At(centre_->z(), range_) == range_;
  const bool centres = centre_ && bad_in_a_row_ % 2 == 0 && (!stays || is_centre_here);
  is_aside_ = stays && centres != is_stranger_centred_;
  if (centres) {
    CentreOn(*centre_);
    return;
  }
  is_centred_ = false;
  if (!stays) {
    searched_range_ = (searched_range_ + 1) % ranges_.size();
    WorkIn(searched_range_);
  }
  population_.SetSpace(ranges_.space(range_));
}

Matrix6d RefinedEstimator::Covariance(bool good) const {
  const Refined& refined = candidate_.refined;
  const Matrix6d of_M =
      good && BothEyes()
          ? WithHidden(covariance_.OfLearnedFace(refined.information, TowardsCamera(*X_CM_)),
                       refined.hidden, X_CM_->translation().normalized())
          : PoseCovariance::OfAnyFace(refined.information);
  return WithLever(of_M, X_CM_->linear() * X_MR_.translation());
}

const Estimate& RefinedEstimator::Process(const StereoFrame& frame, const CameraStep& step,
                                          StageTimer* timer) {
  const EvidenceConfig& e = settings_.refined.evidence;
  timer->Enter(Stage::kFeedforward);
  Feedforward(step);
  estimate_.generations = estimate_.evaluations = 0;
  const bool tracked = X_CM_ && bad_in_a_row_ == 0;
  estimate_.budget_reduced = tracked && effort_.tracking < 1;
  timer->Enter(Stage::kMap);
  frame_ = &frame;
  if (tracked) {
    pair().LookAt(X_CM_->translation());
    TakePictures();
  } else {
    LookInto(range_);
  }
  BuildMaps(tracked ? &*X_CM_ : nullptr);
  one_eye_in_a_row_ = BothEyes() ? 0 : one_eye_in_a_row_ + 1;
  bool good = false;
  if (tracked) {
    timer->Enter(Stage::kRefinement);
    TakeLearned();
    candidate_ = Follow();
    good =
        one_eye_in_a_row_ <= e.one_eye_frames &&
        (texture_.learned() ? IsKnownFace(candidate_, e.keep_texture_ncc) : IsFace(candidate_)) &&
        IsMapped(candidate_.refined.X_CM);
    if (!good) {
      timer->Enter(Stage::kMap);
      if (pair().is_doubled()) LookInto(range_);
      BuildMaps(nullptr);
    }
  }
  estimate_.searched = !good;
  if (!good) {
    estimate_.budget_reduced |= effort_.searching < 1;
    // A stranger who is gone is forgotten: the enrolled face is waited for.
    if (bad_in_a_row_ == kStrangerGone) RememberEnrolled();
    timer->Enter(Stage::kGeneration);
    population_.Renew(0.3);
    colors_before_ = colors_;
    const std::optional<Candidate> there = WhereLost();
    candidate_ = there ? *there : SearchNearest();
    // One eye can keep a track for a while, not begin one: its depth is a guess.
    const bool known = IsKnownAgain(candidate_);
    if (known || !BothEyes()) strange_in_a_row_ = 0;
    good = BothEyes() && (known || IsNewFace());
    if (!good) colors_ = colors_before_;
    // A stranger's face is no rejected place: it must be found again to be learned.
    good || strange_in_a_row_ > 0 ? rejected_.clear() : RejectPlaces();
  } else {
    strange_in_a_row_ = 0;
  }
  timer->Enter(Stage::kOther);
  Judge(good);
  if (!good) learner_.Lose();
  if (good && BothEyes()) LookForEnrolled();
  if (good && BothEyes() && texture_.learned() && !texture_.fixed()) MoveAnchor();
  X_CM_ = candidate_.refined.X_CM;
  if (good && texture_.learned()) known_X_CM_ = X_CM_;
  estimate_.X_CM = *X_CM_ * X_MR_;
  estimate_.fitness = {candidate_.score.total(), -candidate_.score.outside, candidate_.score.inside,
                       candidate_.score.ncc};
  estimate_.covariance = Covariance(good);
  total_generations_ += estimate_.generations;
  if (good && BothEyes()) Learn(frame);  // one eye's depth is no master
  FollowHead();
  ++frames_;
  return estimate_;
}

}  // namespace visavis
