#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/config/rule.h"

namespace visavis {

/// What a calibration board looks like; board.yaml.
struct BoardSpec {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("kind", &kind, OneOf({"charuco", "chessboard"}));
    a->Visit("columns", &columns, InRange(3, 100, "squares"));
    a->Visit("rows", &rows, InRange(3, 100, "squares"));
    a->Visit("square_mm", &square_mm, InRange(1.0, 1000.0, "mm"));
    a->Visit("marker_mm", &marker_mm, InRange(0.5, 1000.0, "mm"));
    a->Visit("dictionary", &dictionary, OneOf({"4x4", "5x5", "6x6", "7x7"}));
  }
  /// @throws FieldError naming key, value and rule.
  void ValidateOrThrow() const;

  std::string kind{"charuco"};
  int columns{16}, rows{11};  ///< squares, outer ones included
  double square_mm{17};
  double marker_mm{12.75};        ///< charuco: side of a marker, its black border included
  std::string dictionary{"4x4"};  ///< charuco: bits of a marker; of 250 markers
};

/// A rectangle on the board [m].
struct BoardRect {
  double x, y, width, height;
};

/// A flat board. T: its frame, origin at its upper left corner, x right, y down, z into it, as one
/// looks at it: a camera straight before it has T parallel to its own. [m]
class Board {
 public:
  /// @throws FieldError, see BoardSpec.
  explicit Board(const BoardSpec& spec);

  const BoardSpec& spec() const { return spec_; }
  double width_m() const { return 1e-3 * spec_.square_mm * spec_.columns; }
  double height_m() const { return 1e-3 * spec_.square_mm * spec_.rows; }

  /// The inner corners, row by row: what detectors find; a corner's index is its id.
  const std::vector<Eigen::Vector3d>& corners() const { return corners_; }
  int corner_columns() const { return spec_.columns - 1; }
  int corner_rows() const { return spec_.rows - 1; }

  /// All that is black; none overlap.
  const std::vector<BoardRect>& black() const { return black_; }

 private:
  void AddMarkers();

  BoardSpec spec_;
  std::vector<Eigen::Vector3d> corners_;
  std::vector<BoardRect> black_;
};

/// Corners of a board that one camera sees.
struct BoardView {
  std::vector<int> ids;                 ///< into Board::corners()
  std::vector<Eigen::Vector2d> pixels;  ///< of each [px]
};

/// A board seen by both cameras at once; either view may be empty.
struct StereoView {
  std::int64_t utime_us{0};
  BoardView right, left;
};

}  // namespace visavis
