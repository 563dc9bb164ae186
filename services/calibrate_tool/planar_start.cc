#include "services/calibrate_tool/planar_start.h"

#include <Eigen/SVD>
#include <opencv2/calib3d.hpp>
#include <stdexcept>
#include <string>

#include "common/geometry/pinhole.h"

namespace visavis {
namespace {

constexpr int kMinViews = 4;

/// Whether the corners seen span an area, and not a line.
bool SpansArea(const Board& board, const BoardView& view) {
  if (static_cast<int>(view.ids.size()) < kMinCorners) return false;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int id : view.ids)
    mean += board.corners()[static_cast<std::size_t>(id)] / static_cast<double>(view.ids.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const int id : view.ids) {
    const Eigen::Vector2d d = (board.corners()[static_cast<std::size_t>(id)] - mean).head<2>();
    scatter += d * d.transpose();
  }
  const double square_m = 1e-3 * board.spec().square_mm;
  return scatter.jacobiSvd().singularValues()[1] > 0.9 * square_m * square_m;
}

}  // namespace

Pinhole StartCamera(const Board& board, const std::vector<const BoardView*>& views, int width,
                    int height) {
  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const BoardView* view : views) {
    if (!SpansArea(board, *view)) continue;
    points.emplace_back();
    pixels.emplace_back();
    for (std::size_t i = 0; i < view->ids.size(); ++i) {
      const Eigen::Vector3d& p = board.corners()[static_cast<std::size_t>(view->ids[i])];
      points.back().emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 0.0F);
      pixels.back().emplace_back(static_cast<float>(view->pixels[i].x()),
                                 static_cast<float>(view->pixels[i].y()));
    }
  }
  if (points.size() < kMinViews) {
    throw std::invalid_argument("views: " + std::to_string(points.size()) +
                                " show enough of the board: must be at least " +
                                std::to_string(kMinViews) + " in each camera");
  }
  const cv::Mat K = cv::initCameraMatrix2D(points, pixels, {width, height}, 0);
  Pinhole camera{
      width, height, K.at<double>(0, 0), K.at<double>(1, 1), 0.5 * (width - 1), 0.5 * (height - 1),
      {}};
  // Views that are all frontal give anything: then a usual lens is as good a start.
  const double usual = 1.2 * width;
  for (double* f : {&camera.fx, &camera.fy})
    if (!(*f > 0.2 * width && *f < 20.0 * width)) *f = usual;
  return camera;
}

std::optional<RigidTransform> StartPose(const Board& board, const BoardView& view,
                                        const Pinhole& camera) {
  if (!SpansArea(board, view)) return std::nullopt;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const Eigen::Vector3d& p = board.corners()[static_cast<std::size_t>(view.ids[i])];
    points.emplace_back(p.x(), p.y(), 0.0);
    const Eigen::Vector3d ray = Unproject(camera, view.pixels[i]);
    pixels.emplace_back(ray.x(), ray.y());
  }
  cv::Vec3d r, t;
  if (!cv::solvePnP(points, pixels, cv::Matx33d::eye(), cv::noArray(), r, t, false,
                    cv::SOLVEPNP_IPPE))
    return std::nullopt;
  const Eigen::Vector3d p_CT(t[0], t[1], t[2]);
  const RigidTransform X_CT = MakeTransform(ExpRotation({r[0], r[1], r[2]}), p_CT);
  for (const int id : view.ids) {
    if (!((X_CT * board.corners()[static_cast<std::size_t>(id)]).z() > 0)) return std::nullopt;
  }
  return X_CT;
}

}  // namespace visavis
