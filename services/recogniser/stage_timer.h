#pragma once

#include <array>
#include <cstddef>

namespace visavis {

/// Stages of one frame, in their order.
enum class Stage { kDecode, kMap, kFeedforward, kGeneration, kRefinement, kOther };

/// Where the time of one frame goes. It only reads; no result depends on it.
class StageTimer {
 public:
  using Now = double (*)();  ///< seconds, monotonic

  explicit StageTimer(Now now) : now_(now) {}

  void Restart() {
    seconds_.fill(0);
    since_ = now_();
    stage_ = Stage::kOther;
  }
  /// Ends the running stage and begins @p stage; a stage entered again adds up.
  void Enter(Stage stage) {
    const double now = now_();
    seconds_[static_cast<std::size_t>(stage_)] += now - since_;
    since_ = now;
    stage_ = stage;
  }
  double Ms(Stage stage) const { return 1e3 * seconds_[static_cast<std::size_t>(stage)]; }
  double TotalMs() const {
    double sum = 0;
    for (const double s : seconds_) sum += s;
    return 1e3 * sum;
  }

 private:
  Now now_;
  std::array<double, 6> seconds_{};
  double since_{0};
  Stage stage_{Stage::kOther};
};

}  // namespace visavis
