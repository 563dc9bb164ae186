// How the refined estimator finds a head whose pose is not known: many glances, a GA, the most
// promising places refined from several sides, the best of them verified by learning from it.
#include <algorithm>
#include <array>
#include <cmath>

#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr double kRejectedFitness = -6;  ///< of a place that proved to be no face
constexpr double kContrastWeight = 2;    ///< in the search's fitness, of 0 to 1
constexpr double kRejected_m = 0.05, kRejectedDepth_m = 0.15;
constexpr std::size_t kMostRejected = 12;
constexpr int kForgiveEvery = 4;  ///< searches in a row
constexpr double kSamePlace_m = 0.025, kSamePlace_rad = 0.15;
constexpr double kTurn_rad = 0.3, kAskew_rad = 0.17, kFar_rad = 0.4, kWide_rad = 0.6;
constexpr std::array<double, 4> kTurns_rad = {0.3, -0.3, 0.55, -0.55};
constexpr int kTurnedReach_px = 9;
constexpr int kFirstIterations = 3, kTurnedIterations = 4;  ///< of each start
constexpr std::size_t kTurnedPlaces = 2;
constexpr std::size_t kPromising = 6;  ///< starts that are refined to the end
constexpr std::size_t kVerified = 3;   ///< best places that are verified
constexpr int kVerifyRounds = 2, kMoreRounds = 2;
constexpr int kMostFaces = 4;          ///< that are told apart by search.nearest_to
constexpr double kLittleEffort = 0.3;  ///< less: no turned starts
constexpr int kFewestShots = 100, kFewestEvaluations = 20;  ///< where the clock lowers them

/// theta, psi [rad]: about kFar_rad apart, over all of @p space.
std::vector<Eigen::Vector2d> Turns(const SearchSpace& space) {
  const auto steps = [&](int i) {
    std::vector<double> angles = {0};
    const auto add = [&](double far) {  // from 0 on
      const int count = std::max(1, static_cast<int>(std::lround(std::abs(far) / kFar_rad)));
      const double step = count == 1 ? std::copysign(kFar_rad, far) : far / count;
      for (int k = 1; k <= count; ++k) angles.push_back(k * step);
    };
    add(std::max(space.max[i], 0.0));
    add(-std::max(-space.min[i], 0.0));
    return angles;
  };
  std::vector<Eigen::Vector2d> turns;
  for (const double theta : steps(4)) {
    for (const double psi : steps(5)) turns.emplace_back(theta, psi);
  }
  return turns;
}

bool AreOnePlace(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation() - b.translation()).norm() < kSamePlace_m &&
         LogRotation(a.linear().transpose() * b.linear()).norm() < kSamePlace_rad;
}

}  // namespace

RefinedEstimator::Candidate RefinedEstimator::Search() {
  const auto unless_rejected = [&](const Vector6d& phi, const auto& evaluate) {
    if (WasRejected(phi)) return kRejectedFitness;
    ++estimate_.evaluations;
    return evaluate(TransformFromPhi(phi));
  };
  const auto with_contrast = [&](double found, const RigidTransform& X) {
    return found + kContrastWeight * Contrast(X);
  };
  const auto fitness = [&](const Vector6d& phi) {
    return unless_rejected(phi, [&](const RigidTransform& X) {
      return with_contrast(head().coarse_fitness.Look(view_, X).found(), X);
    });
  };
  // A child is taken in only where it beats the worst.
  const auto child_fitness = [&](const Vector6d& phi) {
    return unless_rejected(phi, [&](const RigidTransform& X) {
      const double worth = population_.individuals().back().fitness - kContrastWeight;
      const double found = head().coarse_fitness.FoundIfWorth(view_, X, worth);
      return found < worth ? found : with_contrast(found, X);
    });
  };
  const auto shot_fitness = [&](const Vector6d& phi, double worth) {
    return unless_rejected(phi, [&](const RigidTransform& X) {
      return head().shot_fitness.FoundIfWorth(view_, X, worth);
    });
  };
  population_.Evaluate(fitness);
  const RefinedConfig& r = settings_.refined;
  for (const Individual& shot :
       population_.Shoot(Lowered(r.search_shots, effort_.searching, kFewestShots), shot_fitness)) {
    if (shot.fitness == kRejectedFitness) continue;
    population_.Insert(shot.phi, with_contrast(shot.fitness, TransformFromPhi(shot.phi)));
  }
  const int evaluations = Lowered(r.search_evaluations, effort_.searching, kFewestEvaluations);
  const int until = estimate_.evaluations + evaluations;
  const int most = estimate_.generations + evaluations / 10;
  while (estimate_.evaluations < until && estimate_.generations < most) {
    population_.Reproduce(child_fitness);
    ++estimate_.generations;
  }
  RefineStarts(DistinctPlaces());
  if (const auto known = KnownAmongCandidates()) return *known;
  return Recognise(BestVerified());
}

double RefinedEstimator::Contrast(const RigidTransform& X_CM) const {
  const std::size_t eye = view_[0].seen() ? 0 : 1;
  if (!view_[eye].seen()) return 0;
  return head().contrast.Of(*pictures_[eye], pair().eye(eye), X_CM);
}

// Each face found is put aside until no other is found, in each part of the space. The learned
// colours and the maps are those of the face taken.
RefinedEstimator::Candidate RefinedEstimator::SearchNearest() {
  if (!settings_.nearest_to_m || texture_.learned()) return Search();
  const auto distance = [&](const Candidate& candidate) {
    return (candidate.refined.X_CM * X_MR_.translation() - *settings_.nearest_to_m).norm();
  };
  auto colors_nearest = colors_;
  const std::size_t first = range_;
  std::size_t nearest_range = first;
  bool is_any_face = false;
  std::optional<Candidate> nearest;
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const std::size_t range = (first + i) % ranges_.size();
    for (int k = 0; k < kMostFaces; ++k) {
      if (i + static_cast<std::size_t>(k) > 0) {
        colors_ = colors_before_;
        LookInto(range);
        BuildMaps(nullptr);
        population_.Restart();
      }
      const Candidate found = Search();
      const bool is_face = IsFace(found);
      if (!nearest || (is_face && (!is_any_face || distance(found) < distance(*nearest)))) {
        nearest = found;
        nearest_range = range;
        colors_nearest = colors_;
      }
      is_any_face |= is_face;
      if (!is_face) break;
      rejected_.push_back(found.refined.X_CM.translation());
    }
  }
  LookInto(nearest_range);
  colors_ = colors_nearest;
  if (is_any_face) BuildMaps(&nearest->refined.X_CM);
  return *nearest;
}

bool RefinedEstimator::WasRejected(const Vector6d& phi) const {
  return std::any_of(rejected_.begin(), rejected_.end(), [&](const Eigen::Vector3d& p_CM) {
    const Eigen::Vector3d aside = phi.head<3>() - p_CM;
    return aside.head<2>().norm() < kRejected_m && std::abs(aside.z()) < kRejectedDepth_m;
  });
}

// What was looked at closely and is no face is left alone for some frames, so that other places
// have their turn. It may have been a face seen askew: then it is forgiven.
void RefinedEstimator::RejectPlaces() {
  if (bad_in_a_row_ % kForgiveEvery == 0) {
    rejected_.clear();
    return;
  }
  for (const Candidate& candidate : candidates_) {
    const Vector6d phi = PhiFromTransform(candidate.refined.X_CM);
    if (phi.allFinite() && !WasRejected(phi)) rejected_.push_back(phi.head<3>());
    if (rejected_.size() >= kMostRejected) break;
  }
}

std::vector<RigidTransform> RefinedEstimator::DistinctPlaces() const {
  std::vector<RigidTransform> places;
  const int most = Lowered(settings_.refined.search_starts, effort_.searching, 1);
  for (const Individual& individual : population_.individuals()) {
    const RigidTransform X = TransformFromPhi(individual.phi);
    if (std::any_of(places.begin(), places.end(),
                    [&](const RigidTransform& other) { return AreOnePlace(other, X); }))
      continue;
    places.push_back(X);
    if (static_cast<int>(places.size()) == most) break;
  }
  return places;
}

// Each place as found and looking straight ahead, the best ones turned in all directions too: a few
// steps for all of them, the rest for the most promising.
void RefinedEstimator::RefineStarts(const std::vector<RigidTransform>& places) {
  candidates_.clear();
  const auto by_merit = [](const Candidate& a, const Candidate& b) {
    return a.merit() > b.merit();
  };
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto consider = [&](const Eigen::Matrix3d& R_CM) {
      const RigidTransform X = MakeTransform(R_CM, places[i].translation());
      candidates_.push_back(RefineFrom(X, nullptr, kFirstIterations, 10));
    };
    consider(places[i].linear());
    consider(Eigen::Matrix3d::Identity());
    if (i >= kTurnedPlaces || effort_.searching < kLittleEffort) continue;
    for (const double turn : {kTurn_rad, -kTurn_rad}) {
      consider(RotationFromAngles({0, turn, 0}));
      consider(RotationFromAngles({0, 0, turn}));
      consider(RotationFromAngles({0, turn, turn}));
      consider(RotationFromAngles({0, turn, -turn}));
    }
    for (const Eigen::Vector2d& turn : Turns(population_.space())) {
      if (turn.cwiseAbs().maxCoeff() > kFar_rad)
        consider(RotationFromAngles({0, turn[0], turn[1]}));
    }
  }
  const auto drop_implausible = [&] {
    const auto end =
        std::remove_if(candidates_.begin(), candidates_.end(),
                       [&](const Candidate& c) { return !IsPlausible(c.refined.X_CM); });
    if (end != candidates_.begin()) candidates_.erase(end, candidates_.end());
  };
  drop_implausible();
  std::sort(candidates_.begin(), candidates_.end(), by_merit);
  candidates_.resize(std::min(candidates_.size(), kPromising));
  for (Candidate& candidate : candidates_) {
    candidate = RefineFrom(candidate.refined.X_CM, nullptr, settings_.refined.search_iterations, 8);
  }
  drop_implausible();
  std::sort(candidates_.begin(), candidates_.end(), by_merit);
}

// Where the learned face is among the places found: the texture knows it better than the generic
// face does.
std::optional<RefinedEstimator::Candidate> RefinedEstimator::KnownAmongCandidates() {
  std::optional<Candidate> best;
  if (!texture_.learned()) return best;
  const auto consider = [&](const RigidTransform& X) {
    const Candidate known = RefineFrom(X, &texture_, settings_.refined.search_iterations, 7);
    if (IsKnownAgain(known) && (!best || known.refined.texture_ncc > best->refined.texture_ncc))
      best = known;
  };
  for (const Candidate& candidate : candidates_) {
    const RigidTransform& X = candidate.refined.X_CM;
    if (!X.matrix().allFinite() || candidate.score.total() < candidates_[0].score.total() - 1)
      continue;
    consider(X);
  }
  // The generic face may have been fitted askew, beyond what the texture reaches.
  for (std::size_t i = 0; !best && i < std::min(candidates_.size(), kTurnedPlaces); ++i) {
    const RigidTransform X = candidates_[i].refined.X_CM;
    for (const double turn : {kAskew_rad, -kAskew_rad}) {
      for (const double other : {kAskew_rad, 0.0, -kAskew_rad}) {
        consider(X * MakeTransform(ExpRotation({turn, other, 0}), Eigen::Vector3d::Zero()));
      }
      consider(X * MakeTransform(ExpRotation({0, turn, 0}), Eigen::Vector3d::Zero()));
    }
  }
  return best;
}

// Of the best distinct places that which stands the test best; the colours are learned from it.
RefinedEstimator::Candidate RefinedEstimator::BestVerified() {
  std::optional<Candidate> best;
  std::array<RigidTransform, kVerified> places;
  std::size_t tried = 0;
  for (const Candidate& candidate : candidates_) {
    const RigidTransform& X = candidate.refined.X_CM;
    if (std::any_of(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(tried),
                    [&](const RigidTransform& other) { return AreOnePlace(other, X); }))
      continue;
    colors_ = colors_before_;
    const Candidate verified = Verify(candidate);
    if (!best || verified.merit() > best->merit()) {
      best = verified;
      colors_best_ = colors_;
    }
    places[tried++] = X;
    if (tried == kVerified || IsClearFace(*best)) break;
  }
  colors_ = colors_best_;
  if (IsClearFace(*best)) return *best;
  Candidate found = TryTurned(*best);
  for (int k = 0; k < kMoreRounds && !IsFace(found) && IsPromising(found); ++k)
    found = Verify(found);
  if (!IsHead(found) || effort_.searching < kLittleEffort) return found;
  // In a wide space a face may fit turned wrongly, and look well.
  const SearchSpace& space = population_.space();
  const bool is_wide =
      space.max.cwiseAbs().cwiseMax(space.min.cwiseAbs()).tail<3>().maxCoeff() > kWide_rad;
  if (!IsFace(found) || is_wide) found = TryEveryTurn(found);
  if (!IsFace(found)) found = Verify(found);
  return is_wide ? TryAskew(found) : found;
}

// A face seen askew may have been fitted upside down into its own features: turned starts with the
// colours that are now known tell.
RefinedEstimator::Candidate RefinedEstimator::TryTurned(const Candidate& candidate) {
  const Eigen::Matrix3d& R_CM = candidate.refined.X_CM.linear();
  const Eigen::Vector3d angles = AnglesFromRotation(R_CM);
  std::vector<Eigen::Matrix3d> turns = {RotationFromAngles({angles[0], -angles[1], angles[2]}),
                                        RotationFromAngles({angles[0], angles[1], -angles[2]})};
  for (const double turn : kTurns_rad) {
    turns.push_back(R_CM * ExpRotation({turn, 0, 0}));
    turns.push_back(R_CM * ExpRotation({0, turn, 0}));
  }
  return BestTurned(candidate, turns);
}

// A head it is, but its face was not seen: it may look anywhere.
RefinedEstimator::Candidate RefinedEstimator::TryEveryTurn(const Candidate& candidate) {
  const Eigen::Vector3d angles = AnglesFromRotation(candidate.refined.X_CM.linear());
  std::vector<Eigen::Matrix3d> turns;
  for (const Eigen::Vector2d& turn : Turns(population_.space()))
    turns.push_back(RotationFromAngles({angles[0], turn[0], turn[1]}));
  return BestTurned(candidate, turns);
}

RefinedEstimator::Candidate RefinedEstimator::TryAskew(const Candidate& candidate) {
  std::vector<Eigen::Matrix3d> turns;
  for (const double x : {-kAskew_rad, 0.0, kAskew_rad}) {
    for (const double y : {-kAskew_rad, 0.0, kAskew_rad}) {
      for (const double z : {-kAskew_rad, 0.0, kAskew_rad})
        turns.push_back(candidate.refined.X_CM.linear() * ExpRotation({x, y, z}));
    }
  }
  return BestTurned(candidate, turns);
}

// A few steps for all of them, the rest for the best.
RefinedEstimator::Candidate RefinedEstimator::BestTurned(
    const Candidate& candidate, const std::vector<Eigen::Matrix3d>& turns) {
  const RigidTransform X = candidate.refined.X_CM;
  if (!X.matrix().allFinite()) return candidate;
  BuildMaps(&X);
  std::optional<Candidate> turned;
  for (const Eigen::Matrix3d& R_CM : turns) {
    const Candidate other = RefineFrom(MakeTransform(R_CM, X.translation()), nullptr,
                                       kTurnedIterations, kTurnedReach_px);
    if (IsPlausible(other.refined.X_CM) && (!turned || other.merit() > turned->merit()))
      turned = other;
  }
  if (!turned) return candidate;
  turned = RefineFrom(turned->refined.X_CM, nullptr, settings_.refined.search_iterations,
                      kTurnedReach_px);
  const bool is_better = IsPlausible(turned->refined.X_CM) && turned->merit() > candidate.merit();
  return is_better ? *turned : candidate;
}

RefinedEstimator::Candidate RefinedEstimator::Verify(const Candidate& candidate) {
  Candidate verified = candidate;
  for (int round = 0; round < kVerifyRounds; ++round) {
    if (!verified.refined.X_CM.matrix().allFinite()) return verified;
    LearnColors(verified.refined.X_CM);
    BuildMaps(&verified.refined.X_CM);
    verified = RefineFrom(verified.refined.X_CM, nullptr, settings_.refined.iterations, 7);
  }
  return verified;
}

RefinedEstimator::Candidate RefinedEstimator::Recognise(const Candidate& candidate) {
  if (!texture_.learned()) return candidate;
  const Candidate known =
      RefineFrom(candidate.refined.X_CM, &texture_, settings_.refined.search_iterations, 7);
  return IsKnownAgain(known) ? known : candidate;
}

}  // namespace visavis
