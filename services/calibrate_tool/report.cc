#include "services/calibrate_tool/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "services/calibrate_tool/canvas.h"

namespace visavis {
namespace {

constexpr double kDegree = M_PI / 180;
const cv::Scalar kRight(160, 110, 40), kLeft(60, 130, 200), kGrid(225, 225, 225);

template <typename... Value>
std::string Format(const char* format, Value... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// One camera's picture with all corners of all views.
void DrawCoverage(Canvas* canvas, double x, double y, double scale, const std::string& title,
                  const Board& board, const std::vector<const BoardView*>& views,
                  const std::vector<RigidTransform>& X_KT, const Pinhole& camera, double worst_px) {
  const double width = scale * camera.width, height = scale * camera.height;
  CoverageMap map(camera.width, camera.height);
  for (const BoardView* view : views) map.Add(*view);
  for (int i = 1; i < CoverageMap::kColumns; ++i) {
    const double at = x + width * i / CoverageMap::kColumns;
    canvas->Line(at, y, at, y + height, kGrid);
  }
  for (int i = 1; i < CoverageMap::kRows; ++i) {
    const double at = y + height * i / CoverageMap::kRows;
    canvas->Line(x, at, x + width, at, kGrid);
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t k = 0; k < views[i]->ids.size(); ++k) {
      const Eigen::Vector2d& uv = views[i]->pixels[k];
      const Eigen::Vector3d& p_T = board.corners()[static_cast<std::size_t>(views[i]->ids[k])];
      const double error = (Project(camera, X_KT[i] * p_T).uv - uv).norm();
      canvas->Dot(x + scale * (uv.x() + 0.5), y + scale * (uv.y() + 0.5), 2.2,
                  HeatColour(error / worst_px));
    }
  }
  canvas->Frame(x, y, width, height);
  canvas->Text(x, y - 10,
               Format("%s: %.0f %% of the image covered", title.c_str(), 100 * map.share()));
}

}  // namespace

void DrawStereoReport(const std::string& file, const Board& board,
                      const std::vector<StereoView>& views, const StereoCalibration& calibration) {
  const StereoRig& rig = calibration.rig;
  Canvas canvas(1500, 1060);
  canvas.Text(40, 40,
              Format("visavis-calibrate stereo: %zu views, reprojection %.3f px, baseline %.2f mm",
                     views.size(), calibration.rms_px, 1e3 * rig.baseline_m()),
              1.2);
  std::vector<const BoardView*> right, left;
  std::vector<RigidTransform> X_CT, X_LT;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (std::isnan(calibration.right_rms_px[i]) && std::isnan(calibration.left_rms_px[i])) continue;
    right.push_back(&views[i].right);
    left.push_back(&views[i].left);
    X_CT.push_back(calibration.X_CT[i]);
    X_LT.push_back(rig.X_CL.inverse() * calibration.X_CT[i]);
  }
  const double worst_px = RoundUp(2.5 * calibration.rms_px);
  const auto scale = [](const Pinhole& camera) {
    return std::min(660.0 / camera.width, 495.0 / camera.height);
  };
  DrawCoverage(&canvas, 60, 100, scale(rig.left), "left", board, left, X_LT, rig.left, worst_px);
  DrawCoverage(&canvas, 780, 100, scale(rig.right), "right", board, right, X_CT, rig.right,
               worst_px);
  for (int i = 0; i < 200; ++i) canvas.Bar(60 + i, 612, 1, 14, HeatColour(i / 200.0));
  canvas.Text(270, 626, Format("corner off by 0 to %.3g px", worst_px), 0.9);
  canvas.BarChart(110, 690, 610, 300, "left: reprojection error of each view [px]",
                  calibration.left_rms_px, kLeft);
  canvas.BarChart(830, 690, 610, 300, "right: reprojection error of each view [px]",
                  calibration.right_rms_px, kRight);
  canvas.Text(
      60, 1035,
      Format("X_CL +- %.2f %.2f %.2f mm, +- %.3f %.3f %.3f deg (one standard deviation)",
             1e3 * calibration.p_CL_sigma_m[0], 1e3 * calibration.p_CL_sigma_m[1],
             1e3 * calibration.p_CL_sigma_m[2], calibration.r_CL_sigma_rad[0] / kDegree,
             calibration.r_CL_sigma_rad[1] / kDegree, calibration.r_CL_sigma_rad[2] / kDegree));
  canvas.Save(file);
}

void DrawHandEyeReport(const std::string& file, const std::vector<ArmView>& views,
                       const HandEyeCalibration& calibration) {
  Canvas canvas(1500, 900);
  canvas.Text(40, 40,
              Format("visavis-calibrate hand-eye: %zu views, residual %.2f mm and %.3f deg (rms)",
                     views.size(), 1e3 * calibration.residual_rms_m,
                     calibration.residual_rms_rad / kDegree),
              1.2);
  // Where the camera looked from: tilt against the board's normal, as seen from the board.
  const double x0 = 310, y0 = 330, radius = 220, most_deg = 60;
  for (const double deg : {20.0, 40.0, 60.0}) {
    const double r = radius * deg / most_deg;
    for (int i = 0; i < 72; ++i) {
      const double a = i * 5 * kDegree, b = (i + 1) * 5 * kDegree;
      canvas.Line(x0 + r * std::cos(a), y0 + r * std::sin(a), x0 + r * std::cos(b),
                  y0 + r * std::sin(b), kGrid);
    }
    canvas.Text(x0 + 4, y0 - r + 18, Format("%.0f", deg), 0.8);
  }
  canvas.Text(60, 92, "directions from which the board was seen [deg off its normal]");
  std::vector<double> mm, deg;
  const double worst_m = std::max(1e-9, 2.5 * calibration.residual_rms_m);
  for (std::size_t i = 0; i < views.size(); ++i) {
    mm.push_back(1e3 * calibration.residual_m[i]);
    deg.push_back(calibration.residual_rad[i] / kDegree);
    const RigidTransform X_TC = calibration.X_BT.inverse() * views[i].X_BH * calibration.X_HC;
    const Eigen::Vector3d axis = X_TC.linear().col(2);
    const double tilt = std::acos(std::clamp(std::abs(axis.z()), 0.0, 1.0)) / kDegree;
    const Eigen::Vector2d flat = axis.head<2>().stableNormalized();
    const double r = radius * std::min(tilt, most_deg) / most_deg;
    if (std::isfinite(mm.back()))
      canvas.Dot(x0 + r * flat.x(), y0 - r * flat.y(), 6,
                 HeatColour(calibration.residual_m[i] / worst_m));
  }
  for (int i = 0; i < 200; ++i) canvas.Bar(60 + i, 588, 1, 14, HeatColour(i / 200.0));
  canvas.Text(270, 602, Format("residual 0 to %.2g mm", 1e3 * worst_m), 0.9);
  canvas.BarChart(740, 120, 700, 300, "residual of each view [mm]", mm, kRight);
  canvas.BarChart(740, 500, 700, 300, "residual of each view [deg]", deg, kLeft);
  canvas.Text(60, 700,
              Format("X_HC +- %.2f %.2f %.2f mm", 1e3 * calibration.p_HC_sigma_m[0],
                     1e3 * calibration.p_HC_sigma_m[1], 1e3 * calibration.p_HC_sigma_m[2]));
  canvas.Text(
      60, 732,
      Format("     +- %.3f %.3f %.3f deg", calibration.r_HC_sigma_rad[0] / kDegree,
             calibration.r_HC_sigma_rad[1] / kDegree, calibration.r_HC_sigma_rad[2] / kDegree));
  canvas.Text(60, 764, "(one standard deviation; the cameras' own included where known)", 0.9);
  canvas.Text(60, 810,
              Format("board's pose by both eyes: %.3f px; start: %s", calibration.rms_px,
                     calibration.start.c_str()));
  canvas.Save(file);
}

}  // namespace visavis
