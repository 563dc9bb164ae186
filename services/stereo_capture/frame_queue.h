#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "services/stereo_capture/frame_source.h"

namespace visavis {

/// The one way from the cameras' threads to the service's: bounded, and counts what it drops.
class FrameQueue {
 public:
  /// @throws std::system_error where the system has no descriptor left.
  explicit FrameQueue(std::size_t capacity);
  ~FrameQueue();
  FrameQueue(const FrameQueue&) = delete;
  FrameQueue& operator=(const FrameQueue&) = delete;

  /// Takes a frame; where the queue is full the oldest goes.
  void Push(CapturedFrame frame);
  std::optional<CapturedFrame> Pop();

  /// Readable while frames wait.
  int fd() const { return fd_; }
  std::int64_t num_dropped() const;

 private:
  const std::size_t capacity_;
  const int fd_;  // an eventfd, not 0 while frames wait
  mutable std::mutex mutex_;
  std::deque<CapturedFrame> frames_;
  std::int64_t num_dropped_{0};
};

}  // namespace visavis
