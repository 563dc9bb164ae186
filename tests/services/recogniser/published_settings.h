#pragma once

#include <vector>

#include "common/core/clock.h"
#include "services/recogniser/published_estimator.h"
#include "tests/support/stereo_scene.h"

namespace visavis {

/// The published method, every number of it given, so that tuned defaults move no test.
inline PublishedEstimator::Settings PublishedTestSettings() {
  PublishedEstimator::Settings settings;
  settings.space = {PhiOf(-200, -200, 900, -20, -20, -20), PhiOf(200, 200, 1200, 20, 20, 20)};
  settings.recentre = true;
  settings.feedforward = FeedforwardMode::kExact;
  settings.seed = 1;
  settings.ga.individuals = 60;
  settings.ga.bits_per_parameter = 8;
  settings.ga.elite_share = 0.25;
  settings.ga.tournament = 2;
  settings.ga.crossover_probability = 1;
  settings.ga.mutation_probability = 0.05;
  settings.ga.immigrant_share = 0.1;
  settings.ga.carry_remainder = true;
  settings.published.generations_per_frame = 1;
  settings.published.color.hair_min_p = 220;
  settings.published.color.skin_min_value = 50;
  settings.published.color.skin_min_saturation = 30;
  settings.published.fitness.normalised = true;
  TrackMonitorConfig& track = settings.published.track;
  track.min_fitness = 0.8;
  track.min_site = 0.1;
  track.min_color = 0.5;
  track.min_feat = 0.1;
  track.keep_fitness = 0.8;
  track.keep_color = 0.5;
  track.keep_feat = 0.1;
  track.border_share = 0.025;
  track.confirm_frames = 3;
  track.lose_frames = 3;
  track.max_step_mm = 40;
  track.max_step_deg = 12;
  return settings;
}

/// Starts round a known pose.
inline void StartAt(const Vector6d& phi, PublishedEstimator::Settings* settings) {
  settings->start.phi_mm_deg.clear();
  for (int k = 0; k < 6; ++k) {
    settings->start.phi_mm_deg.push_back(phi[k] * (k < 3 ? 1000 : 180 / M_PI));
  }
  settings->start.spread_mm = 8;
  settings->start.spread_deg = 3;
}

/// One estimator on painted pictures.
struct EstimatorRun {
  EstimatorRun(const PublishedEstimator::Settings& settings, const StereoRig& rig)
      : estimator(settings, TestHead(), rig) {
    timer.Restart();
  }
  const Estimate& Process(const StereoFrame& frame, const CameraStep& step = {}) {
    return estimator.Process(frame, step, &timer);
  }
  StageTimer timer{&MonotonicSeconds};
  PublishedEstimator estimator;
};

/// A camera that knows that it did not move for 33 ms.
inline CameraStep AtRest() {
  CameraStep step;
  step.known = true;
  step.dt_s = 0.033;
  return step;
}

inline double PositionErrorMm(const Estimate& estimate, const RigidTransform& X_CM) {
  return 1e3 * ComputeRecognitionError(X_CM, *estimate.X_CM).position.norm();
}
inline double AngleErrorDeg(const Estimate& estimate, const RigidTransform& X_CM) {
  return ComputeRecognitionError(X_CM, *estimate.X_CM).total_angle * 180 / M_PI;
}

}  // namespace visavis
