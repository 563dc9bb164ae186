#include "services/recogniser/published_estimator.h"

#include <algorithm>
#include <cmath>

#include "common/config/config_error.h"

namespace visavis {
namespace {

Vector6d PhiFromMmDeg(const std::vector<double>& values) {
  Vector6d phi;
  for (int i = 0; i < 6; ++i)
    phi[i] = values[static_cast<std::size_t>(i)] * (i < 3 ? 1e-3 : M_PI / 180);
  return phi;
}

// A lost head of which the population shows nothing for so long is looked for afresh, everywhere.
// While it shows something the population is better than a random one.
constexpr int kRestartAfterLostFrames = 30;

}  // namespace

void StartConfig::ValidateOrThrow(const std::string& prefix) const {
  if (!phi_mm_deg.empty() && phi_mm_deg.size() != 6) {
    throw FieldError(prefix + "phi_mm_deg", std::to_string(phi_mm_deg.size()) + " numbers",
                     "must be six, or empty");
  }
  for (const double v : phi_mm_deg) {
    if (!std::isfinite(v))
      throw FieldError(prefix + "phi_mm_deg", "not finite", "must be six numbers");
  }
}

std::optional<RigidTransform> StartConfig::Pose() const {
  if (phi_mm_deg.empty()) return std::nullopt;
  return TransformFromPhi(PhiFromMmDeg(phi_mm_deg));
}

PublishedEstimator::PublishedEstimator(const Settings& settings, const HeadModelConfig& head,
                                       const StereoRig& rig)
    : settings_(settings),
      fitness_(HeadModel(head), rig, settings.published.fitness),
      right_map_(rig.right.width, rig.right.height),
      left_map_(rig.left.width, rig.left.height),
      ga_(settings.ga, settings.space, settings.seed),
      monitor_(settings.published.track),
      reported_(static_cast<std::size_t>(settings.ga.individuals)) {
  Reset();
}

void PublishedEstimator::Reset() {
  monitor_.Reset();
  estimate_ = Estimate{};
  centre_.reset();
  ga_.SetSpace(settings_.space);
  ga_.Restart();
  const StartConfig& start = settings_.start;
  if (start.phi_mm_deg.empty()) return;
  const Vector6d phi = PhiFromMmDeg(start.phi_mm_deg);
  monitor_.Expect(TransformFromPhi(phi));
  CentreOn(phi.head<3>());
  Vector6d spread;
  spread << Eigen::Vector3d::Constant(start.spread_mm * 1e-3),
      Eigen::Vector3d::Constant(start.spread_deg * M_PI / 180);
  ga_.Scatter(phi, spread);
}

void PublishedEstimator::SetSearchSpace(const SearchSpace& space) {
  settings_.space = space;
  centre_.reset();
  ga_.SetSpace(space);
}

void PublishedEstimator::CentreOn(const Eigen::Vector3d& p_CM) {
  if (!settings_.recentre) return;
  centre_ = p_CM;
  ga_.SetSpace(settings_.space.CentredOn(p_CM));
}

StereoMaps PublishedEstimator::BuildMaps(const StereoFrame& frame) {
  StereoMaps maps;
  if (frame.right) {
    right_map_.Build(*frame.right, settings_.published.color);
    maps.right = &right_map_;
  }
  if (frame.left) {
    left_map_.Build(*frame.left, settings_.published.color);
    maps.left = &left_map_;
  }
  return maps;
}

// Fig. 3: all individuals are moved against the camera's motion. @return what was used.
FeedforwardMode PublishedEstimator::Feedforward(const CameraStep& step) {
  if (!step.known) return FeedforwardMode::kNone;
  if (centre_ && settings_.feedforward != FeedforwardMode::kNone) CentreOn(step.X_C2C1 * *centre_);
  switch (settings_.feedforward) {
    case FeedforwardMode::kNone:
      break;
    case FeedforwardMode::kJacobian:
      ga_.Move([&](Vector6d* phi) {
        *phi = EulerStep(*phi, step.X_WC1.linear(), step.twist_1, step.dt_s);
      });
      break;
    case FeedforwardMode::kExact:
      ga_.Move([&](Vector6d* phi) { *phi = Carry(step.X_C2C1, *phi); });
      break;
  }
  return settings_.feedforward;
}

// Fig. 9: evaluate on the new image, output the best, reproduce for the next.
void PublishedEstimator::Evolve(const StereoMaps& maps) {
  const auto fitness = [&](const Vector6d& phi) { return fitness_.Evaluate(maps, phi).total; };
  ga_.Invalidate();
  estimate_.evaluations = 0;
  estimate_.generations = settings_.published.generations_per_frame;
  for (int i = 0; i < estimate_.generations; ++i) {
    if (i > 0) ga_.Reproduce();
    estimate_.evaluations += ga_.Evaluate(fitness);
  }
  total_generations_ += estimate_.generations;
  std::copy(ga_.population().begin(), ga_.population().end(), reported_.begin());
  estimate_.X_CM = TransformFromPhi(ga_.best().phi);
  estimate_.fitness = fitness_.Evaluate(maps, ga_.best().phi);
  ga_.Reproduce();
}

// The search space moves with a tracked head; a head lost for long is looked for everywhere.
void PublishedEstimator::FollowHead() {
  if (estimate_.status == TrackStatus::kTracking) {
    CentreOn(estimate_.X_CM->translation());
  } else if (estimate_.status == TrackStatus::kLost &&
             monitor_.frames_without_head() % kRestartAfterLostFrames ==
                 kRestartAfterLostFrames - 1) {
    centre_.reset();
    ga_.SetSpace(settings_.space);
    ga_.Restart();
  }
}

const Estimate& PublishedEstimator::Process(const StereoFrame& frame, const CameraStep& step,
                                            StageTimer* timer) {
  timer->Enter(Stage::kMap);
  const StereoMaps maps = BuildMaps(frame);
  timer->Enter(Stage::kFeedforward);
  estimate_.feedforward = Feedforward(step);
  timer->Enter(Stage::kGeneration);
  Evolve(maps);
  timer->Enter(Stage::kOther);
  const PackedMap* map = maps.right ? maps.right : maps.left;
  estimate_.status =
      monitor_.Update(*estimate_.X_CM, estimate_.fitness, map->has_color(), step, ga_.space());
  FollowHead();
  return estimate_;
}

}  // namespace visavis
