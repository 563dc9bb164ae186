#pragma once

#include <functional>

namespace visavis {

/// Somebody who does long work beside the frames, one piece at a time.
class Background {
 public:
  virtual ~Background() = default;

  /// Begins @p work; what was begun before must be finished. It owns all that it touches until
  /// IsFinished() has said so.
  virtual void Begin(std::function<void()> work) = 0;
  /// Whether nothing is being done. Where every run must give the same (a replay), waits for that.
  virtual bool IsFinished() = 0;
};

/// Does the work at once.
class NoBackground final : public Background {
 public:
  void Begin(std::function<void()> work) override { work(); }
  bool IsFinished() override { return true; }
};

}  // namespace visavis
