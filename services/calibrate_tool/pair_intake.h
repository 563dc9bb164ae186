#pragma once

#include <cstdint>
#include <optional>

#include "common/image/image_decoder.h"
#include "services/calibrate_tool/board_detector.h"
#include "services/calibrate_tool/view_collector.h"
#include "visavis/images_t.hpp"

namespace visavis {

/// Stereo messages in, views of the board out.
class PairIntake {
 public:
  /// @p board is aliased.
  PairIntake(const Board& board, const CollectorSettings& settings);

  /// @throws MessageError for a message without both images, or whose images are of another size
  /// than the first one's.
  ViewCollector::Verdict Add(const images_t& message);

  /// None before the first pair.
  const std::optional<ViewCollector>& collector() const { return collector_; }
  const ImageSizes& sizes() const { return sizes_; }
  std::int64_t num_pairs() const { return num_pairs_; }
  /// One line on what was left out and why.
  std::string Summary() const;

 private:
  struct Side {
    explicit Side(const Board& board) : detector(board) {}
    ImageDecoder decoder;
    BoardDetector detector;
    double edge_px{0};
  };
  BoardView See(const image_t& message, Side* side);

  const Board& board_;
  const CollectorSettings settings_;
  Side right_, left_;
  ImageSizes sizes_;
  std::optional<ViewCollector> collector_;
  std::int64_t num_pairs_{0};
};

}  // namespace visavis
