#pragma once

#include <memory>

#include "common/image/image.h"
#include "services/calibrate_tool/board.h"

namespace visavis {

/// Finds a board's corners in pictures, to a fraction of a pixel.
class BoardDetector {
 public:
  explicit BoardDetector(const Board& board);
  ~BoardDetector();

  /// Corners seen in @p image (kGray, kRgb or kBgr). A charuco board may be partly seen; a
  /// chessboard wholly or not at all. Empty: none.
  BoardView Detect(const ImageView& image);

  /// Width of the board's edges in the picture that was given last [px]: the way from 0 to 100 % of
  /// their contrast at their steepest, median of those along rows or of those along columns,
  /// whichever is larger; NaN where too few are seen. A sharp lens has 1.5 to 3, motion and blur
  /// add their own.
  double EdgeWidth(const BoardView& view) const;

 private:
  struct Memory;
  const Board& board_;
  std::unique_ptr<Memory> memory_;
};

}  // namespace visavis
