#include "services/stereo_capture/frame_queue.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace visavis {

FrameQueue::FrameQueue(std::size_t capacity)
    : capacity_(capacity), fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

FrameQueue::~FrameQueue() { close(fd_); }

void FrameQueue::Push(CapturedFrame frame) {
  CapturedFrame dropped;  // goes after the lock: it may take the camera's
  const std::lock_guard<std::mutex> lock(mutex_);
  if (frames_.empty()) eventfd_write(fd_, 1);
  frames_.push_back(std::move(frame));
  if (frames_.size() <= capacity_) return;
  dropped = std::move(frames_.front());
  frames_.pop_front();
  ++num_dropped_;
}

std::optional<CapturedFrame> FrameQueue::Pop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (frames_.empty()) return std::nullopt;
  CapturedFrame frame = std::move(frames_.front());
  frames_.pop_front();
  if (frames_.empty()) {
    eventfd_t value = 0;
    eventfd_read(fd_, &value);
  }
  return frame;
}

std::int64_t FrameQueue::num_dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return num_dropped_;
}

}  // namespace visavis
