#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/capture_harness.h"
#include "tests/support/private_network.h"

namespace visavis {

/// For tests of the stereo capture before two small fake cameras, in a network of their own.
class CaptureTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string reason = EnterPrivateNetwork();
    if (!reason.empty()) GTEST_SKIP() << reason;
    options_.left.width = options_.right.width = 320;
    options_.left.height = options_.right.height = 240;
  }

  /// Largest time [s] between messages with a right picture, from the @p first event on.
  static double LongestRightGap(const CaptureHarness& harness, std::size_t first) {
    double longest_s = 0, last_s = harness.events()[first].time_s;
    for (std::size_t i = first; i < harness.events().size(); ++i) {
      const CaptureEvent& event = harness.events()[i];
      if (!event.right_tick) continue;
      longest_s = std::max(longest_s, event.time_s - last_s);
      last_s = event.time_s;
    }
    return longest_s;
  }
  /// Messages without a left picture, from the @p first event on.
  static int CountSingles(const CaptureHarness& harness, std::size_t first) {
    return static_cast<int>(
        std::count_if(harness.events().begin() + static_cast<std::ptrdiff_t>(first),
                      harness.events().end(), [](const CaptureEvent& e) { return !e.left_tick; }));
  }

  CaptureHarness::Options options_;
};

}  // namespace visavis
