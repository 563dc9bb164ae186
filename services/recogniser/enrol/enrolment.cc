#include "services/recogniser/enrol/enrolment.h"

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "services/recogniser/fitness_kernel.h"
#include "services/recogniser/log_player.h"
#include "services/recogniser/refined/face_bundle.h"
#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr int kReadings = 3;
constexpr int kTurns = 2, kRounds = 4;  ///< of the bundle in each; rounds in each turn
constexpr std::size_t kMostViews = 60, kFewestViews = 3;

double NoTime() { return 0; }

struct Reading {
  ViewSelection selection;
  std::array<ColorModel, 2> colors;
  int frames{0}, tracked{0};
};

/// Tracks @p head through the recording.
Reading Track(const std::string& log, const RecogniserConfig& config, const HeadGeometry& head) {
  LogPlayer player(log, config);
  RefinedSettings settings = config.RefinedSettings();
  settings.refined.learned_views = 0;  // the bundle of the whole recording is ours
  RefinedEstimator estimator(settings, head, player.rig());
  StageTimer timer(&NoTime);
  const auto X_RM = MakeTransform(Eigen::Matrix3d::Identity(), -head.p_MR_m);
  Reading reading;
  while (const LogPlayer::Pair* pair = player.Next()) {
    const bool both = pair->frame.right.has_value() && pair->frame.left.has_value();
    const Estimate& estimate = estimator.Process(pair->frame, pair->step, &timer);
    const bool tracked = both && estimate.status == TrackStatus::kTracking;
    const RigidTransform X_CM = tracked ? *estimate.X_CM * X_RM : RigidTransform::Identity();
    reading.selection.Add(reading.frames, tracked ? &X_CM : nullptr);
    reading.tracked += tracked;
    ++reading.frames;
  }
  reading.colors = estimator.colors();
  return reading;
}

/// The pictures of @p views, in a bundle.
std::unique_ptr<HeadBundle> BundleOf(const std::string& log, const RecogniserConfig& config,
                                     const HeadGeometry& head, const Reading& reading) {
  LogPlayer player(log, config);
  const RefinedSettings settings = config.RefinedSettings();
  auto bundle =
      std::make_unique<HeadBundle>(settings.refined.refiner, player.rig(),
                                   settings.space.distance(), head, reading.colors, kFineBand);
  const auto views = reading.selection.Views(kMostViews);
  auto view = views.begin();
  std::int64_t frame = 0;
  while (const LogPlayer::Pair* pair = player.Next()) {
    if (view == views.end()) break;
    if (frame++ != view->frame) continue;
    bundle->Add(pair->frame, view->X_CM);
    ++view;
  }
  return bundle;
}

}  // namespace

Enrolment Enrol(const std::string& log, const RecogniserConfig& config) {
  SelectSimdTarget(config.simd.c_str());
  Enrolment enrolment;
  enrolment.head = config.RefinedHead();
  const HeadSurface start = enrolment.head.surface;
  const FaceFrame finder(TheAdult());
  for (int k = 0; k < kReadings; ++k) {
    const Reading reading = Track(log, config, enrolment.head);
    const std::size_t views = reading.selection.Views(kMostViews).size();
    if (views < kFewestViews) {
      throw std::invalid_argument(log + ": shows a face in " + std::to_string(reading.tracked) +
                                  " of " + std::to_string(reading.frames) + " pairs, from " +
                                  std::to_string(views) + " directions; must be at least " +
                                  std::to_string(kFewestViews) +
                                  " directions: let the person turn the head slowly to all sides");
    }
    const auto bundle = BundleOf(log, config, enrolment.head, reading);
    const FaceBundle bundled = BundleFace(finder, kTurns, kRounds, bundle.get());
    if (k == 0) enrolment.before = bundled.first;
    enrolment.after = bundled.last;
    enrolment.head = bundle->Enrolled();
    enrolment.frames = reading.frames;
    enrolment.tracked = reading.tracked;
    enrolment.views = views;
    enrolment.range = reading.selection.DirectionRange();
  }
  double sum = 0;
  const auto& points = enrolment.head.face->points;
  for (const Eigen::Vector3f& p : points) {
    const double change = static_cast<double>(p.norm() - start.Radius(p.normalized()));
    sum += change * change;
  }
  enrolment.rms_change_mm = 1e3 * std::sqrt(sum / static_cast<double>(points.size()));
  return enrolment;
}

}  // namespace visavis
