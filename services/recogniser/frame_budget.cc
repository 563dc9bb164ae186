#include "services/recogniser/frame_budget.h"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <sstream>
#include <vector>

namespace visavis {
namespace {

constexpr double kMargin = 0.9;                   ///< aimed at, of the budget
constexpr double kAmple = 0.7, kRecovery = 1.03;  ///< below that share of it, up by so much
constexpr double kLargestCut = 0.5;               ///< by one frame
constexpr int kHopeless = 10;                     ///< frames in a row

}  // namespace

void FrameBudget::Took(double ms, bool searched) {
  if (!is_limited()) return;
  Kind& kind = kinds_[searched ? 1 : 0];
  if (ms <= budget_ms_) {
    kind.hopeless_in_a_row = 0;
    if (ms < kAmple * budget_ms_) kind.share = std::min(1.0, kRecovery * kind.share);
    return;
  }
  if (kind.share <= kLeastShare) {
    kind.least_ms = kind.hopeless_in_a_row == 0 ? ms : std::min(kind.least_ms, ms);
    ++kind.hopeless_in_a_row;
  }
  const double cut = std::max(kMargin * budget_ms_ / ms, kLargestCut);
  kind.share = std::max(kind.share * cut, kLeastShare);
}

std::string FrameBudget::TooSmall(const std::string& what_takes, double ms) const {
  std::ostringstream text;
  text << std::setprecision(3) << "refined.budget_ms: " << budget_ms_
       << ": is too small: " << what_takes << " " << ms << " ms here; must be more";
  return text.str();
}

std::string FrameBudget::complaint() const {
  if (is_limited() && generation_ms_ > budget_ms_) {
    return TooSmall("one generation takes", generation_ms_);
  }
  const char* frames[2] = {"a frame with a track", "a frame that is searched"};
  for (std::size_t i = 0; i < 2; ++i) {
    if (kinds_[i].hopeless_in_a_row < kHopeless) continue;
    return TooSmall(std::string(frames[i]) + " with the fewest evaluations takes",
                    kinds_[i].least_ms);
  }
  return "";
}

double LeastGenerationMs(const StereoRig& rig, Estimator* estimator, StageTimer* timer) {
  constexpr int kTries = 3;
  constexpr std::uint8_t kGrey = 128;
  estimator->SetEffort({FrameBudget::kLeastShare, FrameBudget::kLeastShare});
  const auto plain = [&](const Pinhole& camera, std::vector<std::uint8_t>* bytes) {
    const int stride = 3 * camera.width;
    bytes->assign(static_cast<std::size_t>(stride) * static_cast<std::size_t>(camera.height),
                  kGrey);
    return ImageView{bytes->data(), camera.width,  camera.height,
                     stride,        bytes->size(), PixelFormat::kRgb};
  };
  std::vector<std::uint8_t> right, left;
  const StereoFrame frame{0, plain(rig.right, &right), plain(rig.left, &left)};
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTries; ++i) {
    estimator->Reset();
    timer->Restart();
    estimator->Process(frame, {}, timer);
    timer->Enter(Stage::kOther);
    least = std::min(least, timer->Ms(Stage::kRefinement));
  }
  return least;
}

}  // namespace visavis
