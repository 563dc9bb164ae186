#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace visavis {

/// One child process, its output kept in memory. It is killed by its pid at scope end, and by the
/// kernel should the test itself die.
class ChildProcess {
 public:
  /// Starts @p args[0] (a path, or a name in PATH) with stdin empty. @p environment holds
  /// NAME=VALUE over the test's own. @throws std::system_error where it cannot be started.
  explicit ChildProcess(std::vector<std::string> args,
                        const std::vector<std::string>& environment = {});
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const { return pid_; }
  void Signal(int signal) const;

  /// Waits for the end. @return the exit code, or -signal; nothing if it still runs after
  /// @p timeout. May be called again.
  std::optional<int> Wait(std::chrono::milliseconds timeout);

  /// Waits until stdout or stderr holds @p text. @return whether it came within @p timeout and, if
  /// the process ended meanwhile, before its end.
  bool WaitForOutput(const std::string& text, std::chrono::milliseconds timeout);

  /// What it has written so far.
  std::string Out() const;
  std::string Err() const;

 private:
  int out_{-1}, err_{-1};  // memory files, so that a child that writes much is never stopped
  int pidfd_{-1};          // readable once the process has ended
  pid_t pid_{-1};
  std::optional<int> exit_code_;
};

/// Runs a program to its end: its exit code (or -signal) and what it wrote.
struct ProcessResult {
  int exit_code;
  std::string out, err;
};

/// @throws std::runtime_error if it has not ended after @p timeout.
ProcessResult RunProcess(const std::vector<std::string>& args,
                         const std::vector<std::string>& environment = {},
                         std::chrono::milliseconds timeout = std::chrono::seconds(10));

}  // namespace visavis
