#pragma once

#include <Eigen/Core>
#include <array>
#include <ostream>
#include <vector>

#include "services/recogniser/refined/face_points.h"
#include "services/recogniser/refined/head_table.h"

namespace visavis {

/// How far and how adults' heads reach.
struct ShapeModel {
  HeadTable table;  ///< of level 4
  /// Vertices of the table whose radii are those of bare faces, and by row for each how they
  /// differ: one standard deviation of each mode [m] a column.
  std::vector<int> region;
  Eigen::MatrixXd modes_m;
};

/// Places in front of the face, in M, row by row from the top left.
struct LooksGrid {
  int columns{41}, rows{54};
  float left_m{-0.060f}, top_m{-0.045f}, step_m{0.003f};

  int size() const { return columns * rows; }
  int column(int cell) const { return cell % columns; }
  int row(int cell) const { return cell / columns; }
  float x_m(int cell) const { return left_m + step_m * static_cast<float>(column(cell)); }
  float y_m(int cell) const { return top_m + step_m * static_cast<float>(row(cell)); }
  /// The cell at the other side of the face.
  int Mirrored(int cell) const { return cell + columns - 1 - 2 * column(cell); }
};

/// How faces look, by cell of the grid, in units of AdultLooks.
struct LooksModel {
  LooksGrid grid;
  std::vector<bool> known;
  std::array<Eigen::VectorXd, kNumBands> mean, doubt;  ///< doubt: standard deviation left
  /// Fine band: one standard deviation of each mode a column, 0 where not known.
  Eigen::MatrixXd modes;
};

struct TrainedHead {
  ShapeModel shape;
  LooksModel looks;
};

/// Writes it as adult_head.dat keeps it: whole numbers, those of the shape in 10 um (hair_side:
/// 0.1 mm), those of the looks in hundredths; doubt -1: not known.
void WriteHead(const TrainedHead& head, std::ostream* out);

}  // namespace visavis
