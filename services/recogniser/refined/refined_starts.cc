// What becomes of the places that the refined estimator's search found: each is refined from
// several sides, the best of them verified by learning from it.
#include <algorithm>
#include <array>
#include <cmath>

#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr double kSamePlace_m = 0.025, kSamePlace_rad = 0.15;
constexpr double kAskew_rad = 0.17, kFar_rad = 0.4, kWide_rad = 0.6;
constexpr std::array<double, 4> kTurns_rad = {0.3, -0.3, 0.55, -0.55};
constexpr int kFirstReach_px = 10, kReach_px = 8, kTurnedReach_px = 9, kKnownReach_px = 7;
constexpr int kTurnedIterations = 4;
constexpr std::size_t kTurnedPlaces = 2;
constexpr double kGrid_rad = 0.18;     ///< at least
constexpr int kMostSteps = 4;          ///< of the grid, about each axis
constexpr std::size_t kBestTurns = 4;  ///< of the grid, that are tried at a place
constexpr double kNeighbour_m = 0.06;
constexpr std::ptrdiff_t kOfOnePlace = 3;  ///< neighbours among the promising
constexpr std::size_t kPromising = 6;      ///< starts that are refined to the end
constexpr std::size_t kVerified = 3;       ///< best places that are verified
constexpr int kVerifyRounds = 2, kMoreRounds = 2;
constexpr double kSureNcc = 0.9;       ///< of the learned texture: it is nowhere else
constexpr double kLittleEffort = 0.3;  ///< less: no turned starts

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

// The best, but of no place so many that no other is looked at.
void RefinedEstimator::KeepPromising() {
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates_) {
    const auto is_neighbour = [&](const Candidate& other) {
      return (candidate.refined.X_CM.translation() - other.refined.X_CM.translation()).norm() <
             kNeighbour_m;
    };
    if (std::count_if(kept.begin(), kept.end(), is_neighbour) == kOfOnePlace) continue;
    kept.push_back(candidate);
    if (kept.size() == kPromising) break;
  }
  candidates_ = std::move(kept);
}

// Those of a grid over the space's angles that fit best at a place, no two beside each other.
std::vector<Eigen::Matrix3d> RefinedEstimator::BestTurns(const Eigen::Vector3d& p_CM) {
  if (effort_.searching < kLittleEffort) return {};
  const SearchSpace& space = population_.space();
  const auto steps = [&](int i) {
    const int count =
        std::clamp(static_cast<int>(std::lround(space.range()[i] / kGrid_rad)), 1, kMostSteps);
    std::vector<double> angles;
    for (int k = 0; k <= count; ++k) angles.push_back(space.min[i] + space.range()[i] * k / count);
    return angles;
  };
  struct Turn {
    double fitness;
    Eigen::Matrix3d R_CM;
  };
  std::vector<Turn> turns;
  for (const double Phi : steps(3)) {
    for (const double theta : steps(4)) {
      for (const double psi : steps(5)) {
        const Eigen::Matrix3d R_CM = RotationFromAngles({Phi, theta, psi});
        ++estimate_.evaluations;
        turns.push_back(
            {head().coarse_fitness.Look(view_, MakeTransform(R_CM, p_CM)).found(), R_CM});
      }
    }
  }
  std::sort(turns.begin(), turns.end(),
            [](const Turn& a, const Turn& b) { return a.fitness > b.fitness; });
  std::vector<Eigen::Matrix3d> best;
  for (const Turn& turn : turns) {
    if (best.size() == kBestTurns) break;
    const auto is_near = [&](const Eigen::Matrix3d& other) {
      return LogRotation(other.transpose() * turn.R_CM).norm() < kGrid_rad + 0.01;
    };
    if (std::none_of(best.begin(), best.end(), is_near)) best.push_back(turn.R_CM);
  }
  return best;
}

// Each place as found and turned as fits best: a few steps for all of them, the rest for the most
// promising; of one that leaves no doubt at once.
void RefinedEstimator::RefineStarts(const std::vector<RigidTransform>& places) {
  candidates_.clear();
  for (const RigidTransform& place : places) {
    const auto first = static_cast<std::ptrdiff_t>(candidates_.size());
    std::vector<Eigen::Matrix3d> turns = BestTurns(place.translation());
    turns.push_back(place.linear());
    for (const Eigen::Matrix3d& R_CM : turns)
      candidates_.push_back(Scored(head().refiner.RefineRoughly(
          view_, MakeTransform(R_CM, place.translation()), kFirstReach_px)));
    const auto best = std::max_element(
        candidates_.begin() + first, candidates_.end(),
        [](const Candidate& a, const Candidate& b) { return a.log_odds() < b.log_odds(); });
    if (IsSureFace(&*best)) {
      candidates_ = {Candidate(*best)};
      return;
    }
  }
  SortPlausible();
  KeepPromising();
  for (Candidate& candidate : candidates_) {
    candidate =
        RefineFrom(candidate.refined.X_CM, nullptr, settings_.refined.search_iterations, kReach_px);
  }
  SortPlausible();
}

bool RefinedEstimator::IsSureFace(Candidate* rough) {
  if (!IsPlausible(rough->refined.X_CM) || !IsPromising(*rough)) return false;
  const int iterations = settings_.refined.search_iterations;
  *rough = RefineFrom(rough->refined.X_CM, nullptr, iterations, kReach_px);
  if (!texture_.learned()) return IsClearFace(*rough);
  const Candidate known = RefineFrom(rough->refined.X_CM, &texture_, iterations, kKnownReach_px);
  if (!IsKnownAgain(known) || known.refined.texture_ncc < kSureNcc) return false;
  *rough = known;
  return true;
}

// What is plausible, most likely first; if nothing is, what there is.
void RefinedEstimator::SortPlausible() {
  const auto end = std::remove_if(candidates_.begin(), candidates_.end(),
                                  [&](const Candidate& c) { return !IsPlausible(c.refined.X_CM); });
  if (end != candidates_.begin()) candidates_.erase(end, candidates_.end());
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.log_odds() > b.log_odds(); });
}

// Where the learned face is among the places found: the texture knows it better than the generic
// face does.
std::optional<RefinedEstimator::Candidate> RefinedEstimator::KnownAmongCandidates() {
  std::optional<Candidate> best;
  if (!texture_.learned()) return best;
  const auto consider = [&](const RigidTransform& X) {
    const Candidate known =
        RefineFrom(X, &texture_, settings_.refined.search_iterations, kKnownReach_px);
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
    if (!best || verified.log_odds() > best->log_odds()) {
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
    if (IsPlausible(other.refined.X_CM) && (!turned || other.log_odds() > turned->log_odds()))
      turned = other;
  }
  if (!turned) return candidate;
  turned = RefineFrom(turned->refined.X_CM, nullptr, settings_.refined.search_iterations,
                      kTurnedReach_px);
  const bool is_better =
      IsPlausible(turned->refined.X_CM) && turned->log_odds() > candidate.log_odds();
  return is_better ? *turned : candidate;
}

RefinedEstimator::Candidate RefinedEstimator::Verify(const Candidate& candidate) {
  Candidate verified = candidate;
  for (int round = 0; round < kVerifyRounds; ++round) {
    if (!verified.refined.X_CM.matrix().allFinite()) return verified;
    LearnColors(verified.refined.X_CM);
    BuildMaps(&verified.refined.X_CM);
    verified =
        RefineFrom(verified.refined.X_CM, nullptr, settings_.refined.iterations, kKnownReach_px);
  }
  return verified;
}

RefinedEstimator::Candidate RefinedEstimator::Recognise(const Candidate& candidate) {
  if (!texture_.learned()) return candidate;
  const Candidate known = RefineFrom(candidate.refined.X_CM, &texture_,
                                     settings_.refined.search_iterations, kKnownReach_px);
  return IsKnownAgain(known) ? known : candidate;
}

}  // namespace visavis
