// Runs the refined estimator over logs of one subject, from an unknown pose, and prints a line for
// each. Usage: refined_runs [--head head.yaml] [--set KEY=VALUE ...] SEED REFERENCE.lcm LOG.lcm ...
//
// The reference log serves for nothing but the head offset: where the truth's head frame lies in
// the model's is a matter of definition, and constant for a subject. "-" for it: poses are compared
// as they are told, as those of a person's own mesh can be. Columns: log; frames with the
// head, TRACKING %, false TRACKING % (of all frames; above 30 mm or 10 deg aligned, or without a
// head); first lock [frame]; over TRACKING frames after 2 s RMSE mm and deg, aligned by the
// reference, then by the run itself; median and 99th percentile of the time of a frame [ms]; over
// the same frames, aligned by the run itself, the mean of the normalised estimation error squared
// (e' P^-1 e with the covariance P that was told: expected 6), of the position's part and of the
// rotation's (expected 3 each); that offset of the run itself, x y z [mm] and its turn about x, y,
// z [deg]. "-": no such frame.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/config/config_reader.h"
#include "common/core/clock.h"
#include "services/recogniser/background_thread.h"
#include "services/recogniser/log_player.h"
#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr double kSettleS = 2;
constexpr double kFalseMm = 30, kFalseDeg = 10;
constexpr double kDeg = 180 / M_PI;

struct Frame {
  double time_s;
  bool tracking;
  RigidTransform X_CM;
  Eigen::Matrix<double, 6, 6> covariance;
  std::optional<RigidTransform> truth;
  double ms;
};

std::vector<Frame> Run(const std::string& log, const RefinedSettings& settings,
                       const HeadGeometry& head) {
  LogPlayer player(log);
  BackgroundThread background(true);
  RefinedEstimator estimator(settings, head, player.rig(), &background);
  StageTimer timer(&MonotonicSeconds);
  std::vector<Frame> frames;
  std::int64_t start_us = -1;
  while (const LogPlayer::Pair* pair = player.Next()) {
    if (start_us < 0) start_us = pair->frame.utime_us;
    background.IsFinished();  // waited for outside of the time
    timer.Restart();
    const Estimate& estimate = estimator.Process(pair->frame, pair->step, &timer);
    timer.Enter(Stage::kOther);
    frames.push_back({1e-6 * static_cast<double>(pair->frame.utime_us - start_us),
                      estimate.status == TrackStatus::kTracking, *estimate.X_CM,
                      *estimate.covariance, pair->truth, timer.TotalMs()});
  }
  if (frames.empty()) throw std::runtime_error(log + ": no pair");
  return frames;
}

/// X_MT that makes X_CM X_MT the truth in the mean, over TRACKING frames after @p settle_s.
RigidTransform OffsetOf(const std::vector<Frame>& frames, double settle_s) {
  RigidTransform X_MT = RigidTransform::Identity();
  for (int iteration = 0; iteration < 3; ++iteration) {
    Eigen::Vector3d p = Eigen::Vector3d::Zero(), r = p;
    int n = 0;
    for (const Frame& frame : frames) {
      if (!frame.tracking || !frame.truth || frame.time_s < settle_s) continue;
      const RigidTransform rest = (frame.X_CM * X_MT).inverse() * *frame.truth;
      p += rest.translation();
      r += LogRotation(rest.linear());
      ++n;
    }
    if (n == 0) break;
    X_MT = X_MT * MakeTransform(ExpRotation(r / n), Eigen::Vector3d(p / n));
  }
  return X_MT;
}

bool IsMeasured(const Frame& frame) {
  return frame.tracking && frame.truth && frame.time_s >= kSettleS;
}

/// RMSE [mm, deg] over TRACKING frames after the settling time.
std::pair<double, double> Rmse(const std::vector<Frame>& frames, const RigidTransform& X_MT) {
  double mm2 = 0, deg2 = 0;
  int n = 0;
  for (const Frame& frame : frames) {
    if (!IsMeasured(frame)) continue;
    const auto error = ComputeRecognitionError(*frame.truth, frame.X_CM * X_MT);
    mm2 += 1e6 * error.position.squaredNorm();
    deg2 += kDeg * kDeg * error.total_angle * error.total_angle;
    ++n;
  }
  return {std::sqrt(mm2 / std::max(n, 1)), std::sqrt(deg2 / std::max(n, 1))};
}

/// Normalised estimation error squared: of all six, of the position, of the rotation.
Eigen::Vector3d Nees(const std::vector<Frame>& frames, const RigidTransform& X_MT) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int n = 0;
  for (const Frame& frame : frames) {
    if (!IsMeasured(frame)) continue;
    const RigidTransform X_CT = frame.X_CM * X_MT;
    Vector6d e;  // as head_pose_t says: p_CM, small turn about C's axes
    e << frame.truth->translation() - X_CT.translation(),
        LogRotation(frame.truth->linear() * X_CT.linear().transpose());
    const auto squared = [](const auto& error, const auto& covariance) -> double {
      return error.dot(covariance.ldlt().solve(error));
    };
    const Eigen::Matrix3d P_p = frame.covariance.topLeftCorner<3, 3>();
    const Eigen::Matrix3d P_r = frame.covariance.bottomRightCorner<3, 3>();
    const Eigen::Vector3d e_p = e.head<3>(), e_r = e.tail<3>();
    sum += Eigen::Vector3d(squared(e, frame.covariance), squared(e_p, P_p), squared(e_r, P_r));
    ++n;
  }
  return sum / std::max(n, 1);
}

bool IsFalse(const Frame& frame, const RigidTransform& X_MT) {
  if (!frame.tracking) return false;
  if (!frame.truth) return true;
  const auto error = ComputeRecognitionError(*frame.truth, frame.X_CM * X_MT);
  return 1e3 * error.position.norm() > kFalseMm || kDeg * error.total_angle > kFalseDeg;
}

void PrintRow(const std::string& log, const std::vector<Frame>& frames,
              const RigidTransform& X_MT) {
  int with_head = 0, tracking = 0, wrong = 0, first = -1;
  std::vector<double> ms;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i];
    with_head += frame.truth.has_value();
    tracking += frame.tracking && frame.truth;
    wrong += IsFalse(frame, X_MT);
    if (first < 0 && frame.tracking && !IsFalse(frame, X_MT)) first = static_cast<int>(i);
    ms.push_back(frame.ms);
  }
  std::sort(ms.begin(), ms.end());
  std::printf("%s %d %.1f %.2f %d", log.c_str(), with_head,
              100.0 * tracking / std::max(with_head, 1),
              100.0 * wrong / static_cast<double>(frames.size()), first);
  const double median_ms = ms[ms.size() / 2], late_ms = ms[ms.size() * 99 / 100];
  if (std::none_of(frames.begin(), frames.end(), IsMeasured)) {
    std::printf(" - - - - %.2f %.2f - - - - - - - - -\n", median_ms, late_ms);
    return;
  }
  const RigidTransform X_MT_self = OffsetOf(frames, kSettleS);
  const auto [mm, deg] = Rmse(frames, X_MT);
  const auto [self_mm, self_deg] = Rmse(frames, X_MT_self);
  const Eigen::Vector3d nees = Nees(frames, X_MT_self), p = 1e3 * X_MT_self.translation(),
                        turn = kDeg * LogRotation(X_MT_self.linear());
  std::printf(" %.2f %.2f %.2f %.2f %.2f %.2f %.2f %.2f %.2f", mm, deg, self_mm, self_deg,
              median_ms, late_ms, nees[0], nees[1], nees[2]);
  std::printf(" %.1f %.1f %.1f %.1f %.1f %.1f\n", p.x(), p.y(), p.z(), turn.x(), turn.y(),
              turn.z());
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  std::vector<std::string> logs, sets;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool is_flag = argument == "--head" || argument == "--set";
    if (is_flag && i + 1 < argc) {
      sets.emplace_back((argument == "--head" ? "refined.head.file=" : "") +
                        std::string(argv[++i]));
    } else {
      logs.push_back(argument);
    }
  }
  if (logs.size() < 3) {
    std::fputs(
        "usage: refined_runs [--head head.yaml] [--set KEY=VALUE ...] SEED REFERENCE.lcm LOG.lcm "
        "...\n",
        stderr);
    return 2;
  }
  try {
    const auto config = visavis::LoadConfig<visavis::RecogniserConfig>("", sets);
    auto settings = config.RefinedSettings();
    settings.seed = static_cast<std::uint64_t>(std::max(0, std::atoi(logs[0].c_str())));
    const visavis::HeadGeometry head = config.RefinedHead();
    const auto X_MT = logs[1] == "-" ? visavis::RigidTransform::Identity()
                                     : visavis::OffsetOf(visavis::Run(logs[1], settings, head), 0);
    for (std::size_t i = 2; i < logs.size(); ++i) {
      visavis::PrintRow(logs[i], visavis::Run(logs[i], settings, head), X_MT);
    }
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "refined_runs: %s\n", e.what());
    return 1;
  }
}
