#pragma once

#include <string>

namespace visavis {

/// Whether arm states may be used, by what they say of the clock that stamped them. An arm that
/// moves at 0.5 m/s is 2.5 mm elsewhere after 5 ms.
class ArmClock {
 public:
  /// @param bound_ms greatest offset that is used; 0: any.
  explicit ArmClock(double bound_ms) : bound_ms_(bound_ms) {}

  /// Judges one arm state. @param offset_s estimated error of its clock, of either sign; NaN: it
  /// does not say, which is no reason to refuse it.
  /// @return whether it may be used.
  bool Accepts(double offset_s);

  /// Why the last one was refused, with the rule and what mends it; empty: it was not. Names the
  /// first offset of those that are refused in a row, so that it is one complaint.
  const std::string& complaint() const { return complaint_; }
  long num_refused() const { return num_refused_; }

 private:
  double bound_ms_;
  std::string complaint_;
  long num_refused_{0};
};

}  // namespace visavis
