#pragma once

#include <functional>
#include <memory>

#include "services/recogniser/estimator.h"

namespace visavis {

/// Finds out whether the left camera's pictures come as the right one's and the reverse: while no
/// head is found for some time, a second estimator looks at the exchanged pair now and then. A head
/// that both eyes agree on there, time after time, can only be seen when the exchange is right.
class SwapProbe {
 public:
  /// @p make: the second estimator; called when it is first needed.
  explicit SwapProbe(std::function<std::unique_ptr<Estimator>()> make);

  /// To be called once a pair. @return whether Try() is to be called with this pair: every
  /// kPeriod-th of those that bring no head; less and less often while the tries prove nothing.
  bool IsDue(bool is_tracking);
  /// @p exchanged: the pair, its pictures exchanged.
  void Try(const StereoFrame& exchanged, StageTimer* timer);
  /// Back to the beginning, for another rig or session.
  void Forget();

  /// Whether the pictures are swapped: kProofs exchanged pairs in a row showed a head. Until a head
  /// is tracked without the exchange.
  bool found() const { return proofs_ >= kProofs; }

  static constexpr int kPeriod = 6, kLongestPeriod = 96, kProofs = 3;

 private:
  std::function<std::unique_ptr<Estimator>()> make_;
  std::unique_ptr<Estimator> estimator_;
  int fruitless_{0}, period_{kPeriod}, proofs_{0};
};

}  // namespace visavis
