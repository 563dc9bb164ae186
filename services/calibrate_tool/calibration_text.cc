#include "services/calibrate_tool/calibration_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace visavis {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kWorse = 2.5;  // times the whole: worth a look

template <typename... Value>
std::string Format(const char* format, Value... values) {
  char text[300];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string CameraText(const char* name, const Pinhole& c, const CameraSigma& s) {
  return Format("%-6s fx %.2f +- %.2f  fy %.2f +- %.2f  cx %.2f +- %.2f  cy %.2f +- %.2f px\n",
                name, c.fx, s.fx, c.fy, s.fy, c.cx, s.cx, c.cy, s.cy) +
         Format(
             "       k1 %.4f +- %.4f  k2 %.4f +- %.4f  p1 %.5f +- %.5f  p2 %.5f +- %.5f  "
             "k3 %.4f +- %.4f\n",
             c.distortion[0], s.distortion[0], c.distortion[1], s.distortion[1], c.distortion[2],
             s.distortion[2], c.distortion[3], s.distortion[3], c.distortion[4], s.distortion[4]);
}

std::string PoseText(const char* name, const RigidTransform& X, const Eigen::Vector3d& sigma_m,
                     const Eigen::Vector3d& sigma_rad) {
  const Eigen::Vector3d p = 1e3 * X.translation(), sp = 1e3 * sigma_m;
  const Eigen::Vector3d r = LogRotation(X.linear()) / kDegree, sr = sigma_rad / kDegree;
  return Format(
      "%-6s %.2f %.2f %.2f mm +- %.2f %.2f %.2f;  rotation vector %.3f %.3f %.3f deg "
      "+- %.3f %.3f %.3f\n",
      name, p[0], p[1], p[2], sp[0], sp[1], sp[2], r[0], r[1], r[2], sr[0], sr[1], sr[2]);
}

double SecondsSince(std::int64_t utime_us, std::int64_t first_us) {
  return 1e-6 * static_cast<double>(utime_us - first_us);
}

CameraUncertainty ToUncertainty(const CameraSigma& s) {
  return {s.fx, s.fy, s.cx, s.cy, s.distortion};
}

PoseUncertainty ToUncertainty(const Eigen::Vector3d& p_m, const Eigen::Vector3d& r_rad) {
  return {{p_m[0], p_m[1], p_m[2]}, {r_rad[0], r_rad[1], r_rad[2]}};
}

}  // namespace

std::string StereoText(const std::vector<StereoView>& views, const StereoCalibration& calibration) {
  std::string text = "  view      at s  right px  left px   corners\n";
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double worst = std::fmax(calibration.right_rms_px[i], calibration.left_rms_px[i]);
    text += Format("  %4zu  %8.2f  %8.3f %8.3f  %3zu + %zu%s\n", i + 1,
                   SecondsSince(views[i].utime_us, views[0].utime_us), calibration.right_rms_px[i],
                   calibration.left_rms_px[i], views[i].right.ids.size(), views[i].left.ids.size(),
                   worst > kWorse * calibration.rms_px ? "   <- worse than the others" : "");
  }
  text += Format("reprojection error %.3f px (root mean square)\n", calibration.rms_px);
  text += CameraText("right", calibration.rig.right, calibration.right_sigma);
  text += CameraText("left", calibration.rig.left, calibration.left_sigma);
  return text + PoseText("X_CL", calibration.rig.X_CL, calibration.p_CL_sigma_m,
                         calibration.r_CL_sigma_rad);
}

std::string HandEyeText(const std::vector<ArmView>& views, const HandEyeCalibration& calibration) {
  std::string text = "  view      at s        mm       deg\n";
  for (std::size_t i = 0; i < views.size(); ++i) {
    text += Format("  %4zu  %8.2f  %8.3f  %8.4f%s\n", i + 1,
                   SecondsSince(views[i].view.utime_us, views[0].view.utime_us),
                   1e3 * calibration.residual_m[i], calibration.residual_rad[i] / kDegree,
                   calibration.residual_m[i] > kWorse * calibration.residual_rms_m
                       ? "   <- worse than the others"
                       : "");
  }
  text += Format("residual %.3f mm, %.4f deg (root mean square); start by %s\n",
                 1e3 * calibration.residual_rms_m, calibration.residual_rms_rad / kDegree,
                 calibration.start.c_str());
  return text +
         PoseText("X_HC", calibration.X_HC, calibration.p_HC_sigma_m, calibration.r_HC_sigma_rad);
}

RigUncertainty UncertaintyOf(const StereoCalibration& calibration) {
  return {ToUncertainty(calibration.right_sigma), ToUncertainty(calibration.left_sigma),
          ToUncertainty(calibration.p_CL_sigma_m, calibration.r_CL_sigma_rad), std::nullopt};
}

void AddUncertainty(const HandEyeCalibration& calibration, RigDescription* rig) {
  if (rig->uncertainty)
    rig->uncertainty->X_HC = ToUncertainty(calibration.p_HC_sigma_m, calibration.r_HC_sigma_rad);
}

}  // namespace visavis
