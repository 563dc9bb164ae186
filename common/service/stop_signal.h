#pragma once

namespace visavis {

/// Turns SIGINT and SIGTERM into a readable file descriptor. Construct it first in main(), before
/// any thread starts, so that all threads inherit the mask.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  int fd() const { return fd_; }
  /// Whether a signal has come.
  bool pending() const;

 private:
  int fd_;
};

}  // namespace visavis
