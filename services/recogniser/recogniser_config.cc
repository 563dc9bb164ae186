#include "services/recogniser/recogniser_config.h"

#include <stdexcept>

#include "common/config/config_error.h"
#include "common/rigs/rig_file.h"
#include "services/recogniser/chosen_head.h"
#include "services/recogniser/fitness_kernel.h"

namespace visavis {

void RefinedConfig::ValidateOrThrow(const std::string& prefix) const {
  const int least = population.individuals + 2;
  if (track_evaluations != 0 && track_evaluations < least) {
    throw FieldError(prefix + "track_evaluations", std::to_string(track_evaluations),
                     "must be " + std::to_string(least) + " or more, one generation of " + prefix +
                         "population.individuals, or 0");
  }
}

void RecogniserConfig::ValidateOrThrow() const {
  search.ValidateOrThrow("search.");
  start.ValidateOrThrow("start.");
  ga.ValidateOrThrow("ga.");
  refined.ValidateOrThrow("refined.");
  head.ValidateOrThrow("head.");
  RefinedHead();
  RequireRigFile(rig_file);
  if (simd != "auto" &&
      ("," + std::string(SimdTargets()) + ",").find("," + simd + ",") == std::string::npos) {
    throw FieldError("simd", simd, std::string("must be auto or one of ") + SimdTargets());
  }
}

PublishedEstimator::Settings RecogniserConfig::PublishedSettings() const {
  return {published,
          ga,
          SearchSpace::FromConfig(search),
          Recentres(search),
          start,
          ParseFeedforward(feedforward),
          static_cast<std::uint64_t>(seed)};
}

visavis::RefinedSettings RecogniserConfig::RefinedSettings() const {
  visavis::RefinedSettings settings;
  settings.refined = refined;
  settings.space = SearchSpace::FromConfig(search);
  settings.recentre = Recentres(search);
  settings.start_X_CM = start.Pose();
  settings.nearest_to_m = search.NearestTo();
  settings.feedforward = ParseFeedforward(feedforward);
  settings.seed = static_cast<std::uint64_t>(seed);
  return settings;
}

HeadGeometry RecogniserConfig::RefinedHead() const { return ChosenHead(refined.head, head); }

FeedforwardMode ParseFeedforward(const std::string& word) {
  if (word == "none") return FeedforwardMode::kNone;
  if (word == "jacobian") return FeedforwardMode::kJacobian;
  if (word == "exact") return FeedforwardMode::kExact;
  throw std::invalid_argument("feedforward: " + word + ": must be none, jacobian or exact");
}

}  // namespace visavis
