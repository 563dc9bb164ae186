// How the refined estimator finds where heads may be, if nothing is known: many glances, a GA, and
// the best of distinct places evolved each on its own.
#include <algorithm>
#include <cmath>

#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr double kRejectedFitness = -6;  ///< of a place that proved to be no face
constexpr double kContrastWeight = 2;    ///< in the search's fitness, of 0 to 1
constexpr double kRejected_m = 0.05, kRejectedDepth_m = 0.15;
constexpr std::size_t kMostRejected = 12;
constexpr int kForgiveEvery = 4;  ///< searches in a row
constexpr double kSamePlace_m = 0.035, kSamePlaceDepth_m = 0.12;
constexpr int kMostFaces = 4;  ///< that are told apart by search.nearest_to
constexpr int kFewestShots = 100, kFewestEvaluations = 20;  ///< where the clock lowers them

}  // namespace

// Contrast costs as much as all the rest: only those are asked for it that it could make worth it.
double RefinedEstimator::Fitness(const MeshFitness& fitness, const Vector6d& phi, double worth) {
  if (WasRejected(phi)) return kRejectedFitness;
  ++estimate_.evaluations;
  const RigidTransform X = TransformFromPhi(phi);
  const double found = fitness.FoundIfWorth(view_, X, worth - kContrastWeight);
  return found < worth - kContrastWeight ? found : found + kContrastWeight * Contrast(X);
}

RefinedEstimator::Candidate RefinedEstimator::Search() {
  RefineStarts(Places());
  if (const auto known = KnownAmongCandidates()) return *known;
  return Recognise(BestVerified());
}

std::vector<RigidTransform> RefinedEstimator::Places() {
  const RefinedConfig& r = settings_.refined;
  const auto lowered = [&](int count, int least) {
    return Lowered(count, effort_.searching, least);
  };
  const auto worth = [&](const Vector6d& phi, double least) {
    return Fitness(head().coarse_fitness, phi, least);
  };
  population_.Evaluate([&](const Vector6d& phi) { return worth(phi, -INFINITY); });
  best_shots_ = population_.Shoot(
      lowered(r.search_shots, kFewestShots), [&](const Vector6d& phi, double least) {
        if (WasRejected(phi)) return kRejectedFitness;
        ++estimate_.evaluations;
        return head().shot_fitness.FoundIfWorth(view_, TransformFromPhi(phi), least);
      });
  for (Individual& shot : best_shots_) {
    if (shot.fitness <= kRejectedFitness) continue;
    shot.fitness += kContrastWeight * Contrast(TransformFromPhi(shot.phi));
    population_.Insert(shot.phi, shot.fitness);
  }
  const int evaluations = lowered(r.search_evaluations, kFewestEvaluations);
  const int until = estimate_.evaluations + evaluations;
  const int most = estimate_.generations + evaluations / 10;
  while (estimate_.evaluations < until && estimate_.generations < most) {
    population_.Reproduce([&](const Vector6d& phi) {  // a child is taken in if it beats the worst
      return worth(phi, population_.individuals().back().fitness);
    });
    ++estimate_.generations;
  }
  std::vector<RigidTransform> places;
  for (const Vector6d& niche : Niches()) {
    const Individual best =
        population_.Evolve(niche, lowered(r.niche_evaluations, kFewestEvaluations), worth);
    population_.Insert(best.phi, best.fitness);
    places.push_back(TransformFromPhi(best.phi));
  }
  return places;
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

// The best individuals and shots, of each place one.
std::vector<Vector6d> RefinedEstimator::Niches() const {
  std::vector<Individual> all = population_.individuals();
  all.insert(all.end(), best_shots_.begin(), best_shots_.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Individual& a, const Individual& b) { return a.fitness > b.fitness; });
  const Eigen::Array3d apart(kSamePlace_m, kSamePlace_m, kSamePlaceDepth_m);
  const auto most =
      static_cast<std::size_t>(Lowered(settings_.refined.search_niches, effort_.searching, 1));
  std::vector<Vector6d> niches;
  for (const Individual& individual : all) {
    if (individual.fitness <= kRejectedFitness && !niches.empty()) break;
    if (std::none_of(niches.begin(), niches.end(), [&](const Vector6d& other) {
          return ((individual.phi - other).head<3>().array().abs() < apart).all();
        }))
      niches.push_back(individual.phi);
    if (niches.size() == most) break;
  }
  return niches;
}

}  // namespace visavis
