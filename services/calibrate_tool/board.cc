#include "services/calibrate_tool/board.h"

#include <algorithm>
#include <cmath>
#include <opencv2/aruco/charuco.hpp>

#include "common/config/config_error.h"
#include "services/calibrate_tool/charuco.h"

namespace visavis {
namespace {

constexpr int kMaxMarkers = 250;

}  // namespace

void BoardSpec::ValidateOrThrow() const {
  if (kind == "chessboard") {
    if ((columns + rows) % 2 == 0) {
      throw FieldError("rows", std::to_string(rows),
                       "must be even where columns is odd and odd where it is even: else the board "
                       "looks the same upside down");
    }
    return;
  }
  if (!(marker_mm >= 0.3 * square_mm && marker_mm <= 0.9 * square_mm)) {
    throw FieldError("marker_mm", std::to_string(marker_mm),
                     "must be 0.3 to 0.9 of square_mm, as printed");
  }
  if (columns * rows / 2 > kMaxMarkers) {
    throw FieldError("columns", std::to_string(columns),
                     "times rows must be at most 500: there are 250 markers");
  }
}

Board::Board(const BoardSpec& spec) : spec_(spec) {
  spec.ValidateOrThrow();
  const double square = 1e-3 * spec.square_mm;
  for (int row = 1; row < spec.rows; ++row)
    for (int column = 1; column < spec.columns; ++column)
      corners_.emplace_back(square * column, square * row, 0);
  // Markers stand in white squares: which those are, OpenCV decides.
  std::vector<bool> white(static_cast<std::size_t>(spec.columns * spec.rows), false);
  if (spec.kind == "charuco") {
    const auto charuco = MakeCharuco(spec);
    for (const auto& marker : charuco->objPoints) {
      const int column = static_cast<int>(marker[0].x / square);
      const int row = static_cast<int>(0.5F * (marker[0].y + marker[2].y) / square);
      white[static_cast<std::size_t>(row * spec.columns + column)] = true;
    }
    AddMarkers();
  }
  for (int row = 0; row < spec.rows; ++row) {
    for (int column = 0; column < spec.columns; ++column) {
      const bool is_white = spec.kind == "charuco"
                                ? white[static_cast<std::size_t>(row * spec.columns + column)]
                                : (row + column) % 2 == 1;
      if (!is_white) black_.push_back({square * column, square * row, square, square});
    }
  }
}

void Board::AddMarkers() {
  const auto charuco = MakeCharuco(spec_);
  const int bits = charuco->dictionary->markerSize + 2;  // with the black border
  const double cell = 1e-3 * spec_.marker_mm / bits;
  for (std::size_t i = 0; i < charuco->ids.size(); ++i) {
    cv::Mat image;
    cv::aruco::drawMarker(charuco->dictionary, charuco->ids[i], bits, image, 1);
    // Corners of the marker's picture, clockwise from its upper left.
    const auto& corners = charuco->objPoints[i];
    const Eigen::Vector2d origin(corners[0].x, corners[0].y);
    const auto unit = [&](std::size_t to) -> Eigen::Vector2d {
      return (Eigen::Vector2d(corners[to].x, corners[to].y) - origin) / bits;
    };
    const Eigen::Vector2d right = unit(1), down = unit(3);
    for (int row = 0; row < bits; ++row) {
      for (int column = 0; column < bits; ++column) {
        if (image.at<std::uint8_t>(row, column) != 0) continue;
        const Eigen::Vector2d centre = origin + (column + 0.5) * right + (row + 0.5) * down;
        black_.push_back({centre.x() - 0.5 * cell, centre.y() - 0.5 * cell, cell, cell});
      }
    }
  }
}

}  // namespace visavis
