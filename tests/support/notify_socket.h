#pragma once

#include <chrono>
#include <string>

namespace visavis {

/// Stands in for systemd: a NOTIFY_SOCKET to which a service tells READY=1 and the like.
class NotifySocket {
 public:
  NotifySocket();
  ~NotifySocket();
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// "NOTIFY_SOCKET=..." for the child's environment.
  const std::string& variable() const { return variable_; }

  /// Waits for one notification. @return its text; empty if none came within @p timeout.
  std::string Receive(std::chrono::milliseconds timeout);

 private:
  int fd_;
  std::string variable_;
};

}  // namespace visavis
