// calibration_table [TRIALS]: how exactly visavis-calibrate finds X_CL and X_HC of a rig whose
// truth is known, from corners with normal noise. RMS over the trials; each has its own views and
// noise.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "services/calibrate_tool/calibration_text.h"
#include "services/calibrate_tool/hand_eye_solver.h"
#include "services/calibrate_tool/stereo_solver.h"
#include "tests/support/board_scene.h"

namespace visavis {
namespace {

constexpr double kDegree = M_PI / 180;

struct Case {
  const char* name;
  int columns, rows;
  double square_mm;
  int num_views;
  double noise_px;
  double arm_mm, arm_deg;  ///< the arm's own errors, each coordinate
};

struct Squares {
  void Add(const RigidTransform& truth, const RigidTransform& found, double sigma_m,
           double sigma_rad) {
    ++count;
    mm += 1e6 * (truth.translation() - found.translation()).squaredNorm();
    const double angle = LogRotation(truth.linear().transpose() * found.linear()).norm() / kDegree;
    deg += angle * angle;
    told_mm += 1e6 * sigma_m * sigma_m;
    told_deg += sigma_rad * sigma_rad / kDegree / kDegree;
  }
  std::string Text() const {
    const auto rms = [this](double sum) { return std::sqrt(sum / count); };
    char text[96];
    std::snprintf(text, sizeof text, "%.2f (%.2f) | %.3f (%.3f)", rms(mm), rms(told_mm), rms(deg),
                  rms(told_deg));
    return text;
  }
  int count{0};
  double mm{0}, deg{0}, told_mm{0}, told_deg{0};
};

void Run(const Case& c, int num_trials) {
  BoardSpec spec;
  spec.columns = c.columns;
  spec.rows = c.rows;
  spec.square_mm = c.square_mm;
  spec.marker_mm = 0.75 * c.square_mm;
  Squares X_CL, X_HC;
  double rms_px = 0;
  for (int trial = 0; trial < num_trials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(1 + trial);
    const BoardScene scene = MakeBoardScene(spec, c.num_views, seed);
    std::vector<ArmView> views = SeeAll(scene, c.noise_px, 1000 + seed);
    Random random(2000 + seed);
    const auto noise = [&random](double sigma) {
      return Eigen::Vector3d(sigma * random.Normal(), sigma * random.Normal(),
                             sigma * random.Normal());
    };
    std::vector<StereoView> pairs;
    for (ArmView& view : views) {
      pairs.push_back(view.view);
      view.X_BH = view.X_BH *
                  MakeTransform(ExpRotation(noise(kDegree * c.arm_deg)), noise(1e-3 * c.arm_mm));
    }
    StereoSettings settings;
    settings.width = settings.left_width = 640;
    settings.height = settings.left_height = 480;
    const StereoCalibration stereo = CalibrateStereo(scene.board, pairs, settings);
    X_CL.Add(scene.rig.X_CL, stereo.rig.X_CL, stereo.p_CL_sigma_m.norm(),
             stereo.r_CL_sigma_rad.norm());
    rms_px += stereo.rms_px / num_trials;
    HandEyeSettings hand_settings;
    hand_settings.rig_uncertainty = UncertaintyOf(stereo);
    const HandEyeCalibration hand = CalibrateHandEye(scene.board, stereo.rig, views, hand_settings);
    X_HC.Add(scene.X_HC, hand.X_HC, hand.p_HC_sigma_m.norm(), hand.r_HC_sigma_rad.norm());
  }
  std::printf("| %s | %d | %.1f | %.2f | %s | %s |\n", c.name, c.num_views, c.noise_px, rms_px,
              X_CL.Text().c_str(), X_HC.Text().c_str());
  std::fflush(stdout);
}

int Main(int argc, char* argv[]) {
  const int num_trials = argc > 1 ? std::atoi(argv[1]) : 20;
  if (num_trials < 1) {
    std::fprintf(stderr, "calibration_table: %s: TRIALS must be at least 1\n", argv[1]);
    return 2;
  }
  std::printf(
      "| board, squares | views | noise px | reprojection px | X_CL mm (told) | deg "
      "(told) | X_HC mm (told) | deg (told) |\n|---|---|---|---|---|---|---|---|\n");
  for (const Case& c :
       {Case{"16 x 11, 42 mm", 16, 11, 42, 60, 0.2, 0, 0},
        Case{"the same, arm off by 0.2 mm, 0.02 deg", 16, 11, 42, 60, 0.2, 0.2, 0.02},
        Case{"the same", 16, 11, 42, 20, 0.2, 0, 0}, Case{"the same", 16, 11, 42, 60, 0.5, 0, 0},
        Case{"16 x 11, 25 mm (A3)", 16, 11, 25, 60, 0.2, 0, 0},
        Case{"16 x 11, 17 mm (A4)", 16, 11, 17, 60, 0.2, 0, 0},
        Case{"11 x 8, 60 mm", 11, 8, 60, 60, 0.2, 0, 0}})
    Run(c, num_trials);
  return 0;
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  try {
    return visavis::Main(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "calibration_table: %s\n", e.what());
    return 1;
  }
}
