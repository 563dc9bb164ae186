#include "services/recogniser/swap_probe.h"

#include <algorithm>
#include <utility>

namespace visavis {

SwapProbe::SwapProbe(std::function<std::unique_ptr<Estimator>()> make) : make_(std::move(make)) {}

bool SwapProbe::IsDue(bool is_tracking) {
  if (is_tracking) {
    Forget();
    return false;
  }
  if (++fruitless_ < period_) return false;
  fruitless_ = 0;
  return true;
}

// Each time from nothing: a head that was found must be found again.
void SwapProbe::Try(const StereoFrame& exchanged, StageTimer* timer) {
  if (!estimator_) estimator_ = make_();
  estimator_->Reset();
  bool is_head = false;
  for (int i = 0; i < estimator_->frames_of_a_search() && !is_head; ++i)
    is_head = estimator_->Process(exchanged, {}, timer).status == TrackStatus::kTracking;
  proofs_ = is_head ? proofs_ + 1 : 0;
  period_ = is_head ? kPeriod : std::min(2 * period_, kLongestPeriod);
}

void SwapProbe::Forget() {
  estimator_.reset();
  fruitless_ = proofs_ = 0;
  period_ = kPeriod;
}

}  // namespace visavis
