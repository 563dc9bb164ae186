#include "services/calibrate_tool/board_detector.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "services/calibrate_tool/charuco.h"

namespace visavis {
namespace {

constexpr int kProfileHalf = 24;  // quarter pixels to each side of an edge
constexpr std::size_t kMinEdges = 4;
constexpr int kMinWindow = 2, kMaxWindow = 8;  // half sides [px]

double At(const cv::Mat& grey, const Eigen::Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
  const double a = p.x() - x, b = p.y() - y;
  const std::uint8_t *top = grey.ptr(y) + x, *bottom = grey.ptr(y + 1) + x;
  return (1 - b) * ((1 - a) * top[0] + a * top[1]) + b * ((1 - a) * bottom[0] + a * bottom[1]);
}

/// Width of the edge between two neighbouring corners, across its middle; NaN: outside the picture.
double WidthOfEdge(const cv::Mat& grey, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = (b - a).normalized(), across(-along.y(), along.x());
  // A quarter of a square's side to each side, so that no marker comes into it.
  const double reach = std::min(0.25 * kProfileHalf, 0.11 * (b - a).norm());
  const Eigen::Vector2d middle = 0.5 * (a + b);
  for (const double side : {-reach - 1, reach + 1}) {
    const Eigen::Vector2d p = middle + side * across;
    if (!(p.x() >= 0 && p.y() >= 0 && p.x() < grey.cols - 1 && p.y() < grey.rows - 1))
      return std::nan("");
  }
  // The mean of some profiles along the edge, against noise.
  constexpr int kSteps = 4;
  const int half = static_cast<int>(kSteps * reach);
  std::vector<double> profile;
  for (int i = -half; i <= half; ++i) {
    double sum = 0;
    for (int k = -2; k <= 2; ++k)
      sum += At(grey, middle + (static_cast<double>(i) / kSteps) * across +
                          0.05 * k * (b - a).norm() * along);
    profile.push_back(sum / 5);
  }
  if (static_cast<int>(profile.size()) <= kSteps) return std::nan("");
  double steepest = 0;
  for (std::size_t i = kSteps; i < profile.size(); ++i)
    steepest = std::max(steepest, std::abs(profile[i] - profile[i - kSteps]));  // in 1 px
  const auto [least, most] = std::minmax_element(profile.begin(), profile.end());
  const double contrast = *most - *least;
  return contrast < 20 ? std::nan("") : contrast / steepest;
}

/// Moves corners to where the picture has them.
void Refine(const Board& board, const cv::Mat& grey, const std::vector<int>& ids,
            std::vector<cv::Point2f>* corners) {
  // OpenCV 4.6 counts charuco corners from the pixel's edge, and other versions do not; refined
  // from wherever they are they are the picture's own, counted from the pixel's centre. The window
  // must not reach the marker beside the corner.
  std::map<int, cv::Point2f> pixel_of;
  for (std::size_t i = 0; i < ids.size(); ++i) pixel_of[ids[i]] = (*corners)[i];
  const BoardSpec& spec = board.spec();
  const double clear = spec.kind == "charuco" ? 0.5 * (1 - spec.marker_mm / spec.square_mm) : 0.3;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    double side = 1e9;
    for (const int step : {-1, 1, -board.corner_columns(), board.corner_columns()}) {
      const auto next = pixel_of.find(ids[i] + step);
      const int column = ids[i] % board.corner_columns();
      if (next == pixel_of.end() || (step == 1 && column + 1 == board.corner_columns()) ||
          (step == -1 && column == 0))
        continue;
      side = std::min(side, cv::norm(next->second - (*corners)[i]));
    }
    const int half = side > 1e8
                         ? kMinWindow
                         : std::clamp(static_cast<int>(clear * side), kMinWindow, kMaxWindow);
    std::vector<cv::Point2f> one{(*corners)[i]};
    cv::cornerSubPix(grey, one, {half, half}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 0.002});
    (*corners)[i] = one[0];
  }
}

}  // namespace

struct BoardDetector::Memory {
  cv::Ptr<cv::aruco::CharucoBoard> charuco;
  cv::Ptr<cv::aruco::DetectorParameters> parameters = cv::aruco::DetectorParameters::create();
  cv::Mat grey;
};

BoardDetector::BoardDetector(const Board& board)
    : board_(board), memory_(std::make_unique<Memory>()) {
  if (board.spec().kind == "charuco") memory_->charuco = MakeCharuco(board.spec());
}

BoardDetector::~BoardDetector() = default;

BoardView BoardDetector::Detect(const ImageView& image) {
  const int type = image.format == PixelFormat::kGray ? CV_8UC1 : CV_8UC3;
  const cv::Mat picture(image.height, image.width, type, const_cast<std::uint8_t*>(image.data),
                        static_cast<std::size_t>(image.stride));
  if (image.format == PixelFormat::kGray) {
    picture.copyTo(memory_->grey);
  } else {
    cv::cvtColor(picture, memory_->grey,
                 image.format == PixelFormat::kRgb ? cv::COLOR_RGB2GRAY : cv::COLOR_BGR2GRAY);
  }
  BoardView view;
  std::vector<cv::Point2f> corners;
  if (memory_->charuco) {
    std::vector<std::vector<cv::Point2f>> markers;
    std::vector<int> marker_ids;
    cv::aruco::detectMarkers(memory_->grey, memory_->charuco->dictionary, markers, marker_ids,
                             memory_->parameters);
    if (marker_ids.empty()) return view;
    cv::aruco::interpolateCornersCharuco(markers, marker_ids, memory_->grey, memory_->charuco,
                                         corners, view.ids);
  } else {
    const cv::Size size(board_.corner_columns(), board_.corner_rows());
    if (!cv::findChessboardCornersSB(memory_->grey, size, corners)) return view;
    // Corner 0 lies at a black square of the board's corner: the square inside of it, between
    // corners 0 and its diagonal neighbour, is black too.
    const auto at = [&](int column, int row) {
      const cv::Point2f& p = corners[static_cast<std::size_t>(row * size.width + column)];
      return Eigen::Vector2d(p.x, p.y);
    };
    const auto middle = [&](int column, int row) {
      return At(memory_->grey, 0.25 * (at(column, row) + at(column + 1, row) + at(column, row + 1) +
                                       at(column + 1, row + 1)));
    };
    if (middle(0, 0) > middle(1, 0)) std::reverse(corners.begin(), corners.end());
    for (std::size_t i = 0; i < corners.size(); ++i) view.ids.push_back(static_cast<int>(i));
  }
  if (!corners.empty()) Refine(board_, memory_->grey, view.ids, &corners);
  for (const cv::Point2f& p : corners) view.pixels.emplace_back(p.x, p.y);
  return view;
}

double BoardDetector::EdgeWidth(const BoardView& view) const {
  std::map<int, Eigen::Vector2d> pixel_of;
  for (std::size_t i = 0; i < view.ids.size(); ++i) pixel_of[view.ids[i]] = view.pixels[i];
  // Motion widens the edges across it alone: those along rows and along columns are judged apart.
  double widest = std::nan("");
  for (const int step : {1, board_.corner_columns()}) {
    std::vector<double> widths;
    for (const auto& [id, pixel] : pixel_of) {
      if (step == 1 && (id + 1) % board_.corner_columns() == 0) continue;
      const auto next = pixel_of.find(id + step);
      if (next == pixel_of.end()) continue;
      const double width = WidthOfEdge(memory_->grey, pixel, next->second);
      if (std::isfinite(width)) widths.push_back(width);
    }
    if (widths.size() < kMinEdges) continue;
    const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), middle, widths.end());
    widest = std::fmax(widest, *middle);
  }
  return widest;
}

}  // namespace visavis
