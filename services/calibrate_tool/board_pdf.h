#pragma once

#include <string>

#include "services/calibrate_tool/board.h"

namespace visavis {

/// Paper [mm], landscape or not as given.
struct Paper {
  double width_mm, height_mm;
};

/// "a4", "a3", "a2", "a1", "a0", "letter", "tabloid" in landscape, or "WxH" in mm.
/// @throws std::invalid_argument for anything else.
Paper ParsePaper(const std::string& name);

/// A PDF of one page that shows the board in its middle, true to scale, with a line of 100 mm to
/// measure the print by. The board's x goes right and its y down.
/// @throws std::invalid_argument where the board does not fit on the paper.
std::string BoardPdf(const Board& board, const Paper& paper);

}  // namespace visavis
