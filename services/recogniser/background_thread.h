#pragma once

#include <functional>
#include <future>

#include "services/recogniser/refined/background.h"

namespace visavis {

/// A thread beside the service's own, of lower priority.
class BackgroundThread final : public Background {
 public:
  /// @p waits: for a replay, IsFinished() waits until the work is done, so that no run depends on
  /// how fast it was; else it never does.
  explicit BackgroundThread(bool waits) : waits_(waits) {}
  /// Waits for what was begun.
  ~BackgroundThread() override;

  void Begin(std::function<void()> work) override;
  bool IsFinished() override;

 private:
  const bool waits_;
  std::future<void> work_;
};

}  // namespace visavis
