#pragma once

#include <optional>
#include <string>
#include <vector>

#include "services/calibrate_tool/board.h"

namespace visavis {

/// Which views are worth keeping; calibrate's flags.
struct CollectorSettings {
  int num_views{60};
  int min_corners{12};             ///< in each image, >= 6
  double max_edge_px{4.5};         ///< edges wider are blurred
  double max_motion_px{1.0};       ///< corners that move more from one picture to the next
  std::int64_t still_us{250'000};  ///< the next picture comes within; later ones tell no motion
  double min_change_px{40};        ///< corners that differ less from a view kept: nothing new
};

/// Size of the two images [px].
struct ImageSizes {
  int width{0}, height{0}, left_width{0}, left_height{0};
};

/// How much of one image the corners kept so far cover, cell by cell.
class CoverageMap {
 public:
  static constexpr int kColumns = 8, kRows = 6;
  CoverageMap(int width, int height) : width_(width), height_(height) {}
  void Add(const BoardView& view);
  int count(int column, int row) const { return counts_[row * kColumns + column]; }
  double share() const;  ///< of cells with a corner, 0 to 1
  /// "upper left", "middle" ...: the emptiest ninth of the image; empty: all have some.
  std::string EmptiestPlace() const;

 private:
  int width_, height_;
  int counts_[kColumns * kRows]{};
};

/// Chooses views as they come, and says what is still missing.
class ViewCollector {
 public:
  enum class Verdict { kKept, kNoBoard, kBlurred, kMoving, kNothingNew };
  static constexpr int kNumVerdicts = 5;

  ViewCollector(const Board& board, const CollectorSettings& settings, const ImageSizes& sizes);

  /// Offers a pair, in the order of time. @p edge_px  widest of both images' edges, NaN: unknown.
  Verdict Offer(const StereoView& view, double edge_px);

  const std::vector<StereoView>& views() const { return views_; }
  bool complete() const { return static_cast<int>(views_.size()) >= settings_.num_views; }
  int count(Verdict verdict) const { return counts_[static_cast<int>(verdict)]; }
  const CoverageMap& right_coverage() const { return right_; }
  const CoverageMap& left_coverage() const { return left_; }

  /// One line: what to do next. Empty: all is well covered.
  std::string Guide() const;

  /// Whether it is worth saying why: "blurred", "moving" ...
  static const char* Name(Verdict verdict);

 private:
  Verdict Judge(const StereoView& view, double edge_px) const;
  /// Mean way of the corners that both views have [px]; none: too few in common.
  static std::optional<double> MeanWay(const BoardView& a, const BoardView& b);
  /// How much nearer one edge of the board is than the other: 0 is frontal.
  double Tilt(const BoardView& view) const;

  const Board& board_;
  const CollectorSettings settings_;
  CoverageMap right_, left_;
  std::vector<StereoView> views_;
  std::optional<StereoView> last_;
  int counts_[kNumVerdicts]{};
  int num_tilted_{0};
  double least_scale_{0}, most_scale_{0};  ///< square's side [px]
};

}  // namespace visavis
