#include "services/calibrate_tool/view_collector.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace visavis {
namespace {

constexpr double kTilted = 0.05;       // of the board's size in the picture
constexpr double kEnoughTilted = 0.3;  // of the views
constexpr double kEnoughScale = 1.3;   // nearest over farthest

/// Sides of squares [px] along rows and columns.
std::vector<double> Sides(const BoardView& view, int corner_columns) {
  std::map<int, Eigen::Vector2d> pixel_of;
  for (std::size_t i = 0; i < view.ids.size(); ++i) pixel_of[view.ids[i]] = view.pixels[i];
  std::vector<double> sides;
  for (const auto& [id, pixel] : pixel_of) {
    for (const int step : {1, corner_columns}) {
      if (step == 1 && (id + 1) % corner_columns == 0) continue;
      const auto next = pixel_of.find(id + step);
      if (next != pixel_of.end()) sides.push_back((next->second - pixel).norm());
    }
  }
  return sides;
}

}  // namespace

void CoverageMap::Add(const BoardView& view) {
  for (const Eigen::Vector2d& uv : view.pixels) {
    const int column = static_cast<int>(uv.x() / width_ * kColumns);
    const int row = static_cast<int>(uv.y() / height_ * kRows);
    if (column >= 0 && column < kColumns && row >= 0 && row < kRows)
      ++counts_[row * kColumns + column];
  }
}

double CoverageMap::share() const {
  const auto covered =
      std::count_if(std::begin(counts_), std::end(counts_), [](int count) { return count > 0; });
  return static_cast<double>(covered) / (kColumns * kRows);
}

std::string CoverageMap::EmptiestPlace() const {
  static const char* const names[3][3] = {{"upper left", "top", "upper right"},
                                          {"left", "middle", "right"},
                                          {"lower left", "bottom", "lower right"}};
  int empty[3][3] = {}, most = 0;
  const char* place = "";
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      if (count(column, row) == 0) ++empty[row * 3 / kRows][column * 3 / kColumns];
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if (empty[row][column] <= most) continue;
      most = empty[row][column];
      place = names[row][column];
    }
  }
  return place;
}

ViewCollector::ViewCollector(const Board& board, const CollectorSettings& settings,
                             const ImageSizes& sizes)
    : board_(board),
      settings_(settings),
      right_(sizes.width, sizes.height),
      left_(sizes.left_width, sizes.left_height) {}

const char* ViewCollector::Name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kKept:
      return "kept";
    case Verdict::kNoBoard:
      return "without enough of the board in both images";
    case Verdict::kBlurred:
      return "blurred";
    case Verdict::kMoving:
      return "moving";
    case Verdict::kNothingNew:
      return "like one before";
  }
  return "";
}

std::optional<double> ViewCollector::MeanWay(const BoardView& a, const BoardView& b) {
  std::map<int, Eigen::Vector2d> pixel_of;
  for (std::size_t i = 0; i < a.ids.size(); ++i) pixel_of[a.ids[i]] = a.pixels[i];
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < b.ids.size(); ++i) {
    const auto found = pixel_of.find(b.ids[i]);
    if (found == pixel_of.end()) continue;
    sum += (found->second - b.pixels[i]).norm();
    ++count;
  }
  if (count < 4) return std::nullopt;
  return sum / count;
}

double ViewCollector::Tilt(const BoardView& view) const {
  // Perspective: sides of squares grow towards the near edge.
  std::vector<double> sides = Sides(view, board_.corner_columns());
  if (sides.size() < 8) return 0;
  std::sort(sides.begin(), sides.end());
  return sides[sides.size() * 9 / 10] / sides[sides.size() / 10] - 1;
}

ViewCollector::Verdict ViewCollector::Judge(const StereoView& view, double edge_px) const {
  const auto least = std::min(view.right.ids.size(), view.left.ids.size());
  if (static_cast<int>(least) < settings_.min_corners) return Verdict::kNoBoard;
  if (edge_px > settings_.max_edge_px) return Verdict::kBlurred;
  if (last_ && view.utime_us - last_->utime_us <= settings_.still_us) {
    for (const auto& way : {MeanWay(last_->right, view.right), MeanWay(last_->left, view.left)}) {
      if (!way || *way > settings_.max_motion_px) return Verdict::kMoving;
    }
  }
  for (const StereoView& kept : views_) {
    const auto way = MeanWay(kept.right, view.right);
    if (way && *way < settings_.min_change_px) return Verdict::kNothingNew;
  }
  return Verdict::kKept;
}

ViewCollector::Verdict ViewCollector::Offer(const StereoView& view, double edge_px) {
  const Verdict verdict = Judge(view, edge_px);
  ++counts_[static_cast<int>(verdict)];
  last_ = view;
  if (verdict != Verdict::kKept) return verdict;
  views_.push_back(view);
  right_.Add(view.right);
  left_.Add(view.left);
  if (Tilt(view.right) > kTilted) ++num_tilted_;
  std::vector<double> sides = Sides(view.right, board_.corner_columns());
  if (sides.empty()) return verdict;
  const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
  std::nth_element(sides.begin(), middle, sides.end());
  least_scale_ = least_scale_ > 0 ? std::min(least_scale_, *middle) : *middle;
  most_scale_ = std::max(most_scale_, *middle);
  return verdict;
}

std::string ViewCollector::Guide() const {
  if (views_.empty()) return "show the board to both cameras";
  std::string guide;
  const auto say = [&guide](const std::string& what) {
    guide += (guide.empty() ? "" : "; ") + what;
  };
  const std::string right = right_.EmptiestPlace(), left = left_.EmptiestPlace();
  if (!right.empty() && right_.share() < 0.9) say("right image: nothing yet at the " + right);
  if (!left.empty() && left_.share() < 0.8) say("left image: nothing yet at the " + left);
  if (num_tilted_ < kEnoughTilted * static_cast<double>(views_.size())) say("tilt the board more");
  if (views_.size() >= 3 && most_scale_ < kEnoughScale * least_scale_) say("go nearer and farther");
  return guide;
}

}  // namespace visavis
