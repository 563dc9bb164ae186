#include "tests/support/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

namespace visavis {
namespace {

using Clock = std::chrono::steady_clock;

int CheckedFd(int fd, const char* what) {
  if (fd < 0) throw std::system_error(errno, std::generic_category(), what);
  return fd;
}

std::string ReadAll(int fd) {
  std::string text;
  std::array<char, 4096> chunk;
  while (true) {
    const ssize_t n = pread(fd, chunk.data(), chunk.size(), static_cast<off_t>(text.size()));
    if (n <= 0) return text;
    text.append(chunk.data(), static_cast<std::size_t>(n));
  }
}

std::vector<char*> Pointers(std::vector<std::string>* strings) {
  std::vector<char*> pointers;
  for (auto& text : *strings) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> Environment(const std::vector<std::string>& over) {
  std::vector<std::string> result(over);
  for (char** entry = environ; *entry; ++entry) {
    const std::string text(*entry);
    const std::string name = text.substr(0, text.find('=') + 1);
    bool replaced = false;
    for (const auto& o : over) replaced = replaced || o.rfind(name, 0) == 0;
    if (!replaced) result.push_back(text);
  }
  return result;
}

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> args,
                           const std::vector<std::string>& environment) {
  out_ = CheckedFd(memfd_create("stdout", MFD_CLOEXEC), "memfd_create");
  err_ = CheckedFd(memfd_create("stderr", MFD_CLOEXEC), "memfd_create");
  // All that allocates comes before fork(): the test may have threads.
  const auto argv = Pointers(&args);
  auto variables = Environment(environment);
  const auto envp = Pointers(&variables);
  const int nothing = CheckedFd(open("/dev/null", O_RDONLY | O_CLOEXEC), "/dev/null");
  const pid_t parent = getpid();
  pid_ = CheckedFd(fork(), "fork");
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(127);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    dup2(nothing, STDIN_FILENO);
    dup2(out_, STDOUT_FILENO);
    dup2(err_, STDERR_FILENO);
    execvpe(argv[0], argv.data(), envp.data());
    _exit(127);
  }
  close(nothing);
  // By number: the header of glibc 2.36 forgets extern "C".
  pidfd_ = CheckedFd(static_cast<int>(syscall(SYS_pidfd_open, pid_, 0)), "pidfd_open");
}

ChildProcess::~ChildProcess() {
  if (!exit_code_) {
    Signal(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(pidfd_);
  close(out_);
  close(err_);
}

void ChildProcess::Signal(int signal) const {
  if (!exit_code_) kill(pid_, signal);
}

std::optional<int> ChildProcess::Wait(std::chrono::milliseconds timeout) {
  if (exit_code_) return exit_code_;
  pollfd ended{pidfd_, POLLIN, 0};
  if (poll(&ended, 1, static_cast<int>(timeout.count())) <= 0) return std::nullopt;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return exit_code_;
}

bool ChildProcess::WaitForOutput(const std::string& text, std::chrono::milliseconds timeout) {
  const auto deadline = Clock::now() + timeout;
  while (true) {
    const bool over = Wait(std::chrono::milliseconds(2)).has_value() || Clock::now() > deadline;
    if ((Out() + '\n' + Err()).find(text) != std::string::npos) return true;
    if (over) return false;
  }
}

std::string ChildProcess::Out() const { return ReadAll(out_); }

std::string ChildProcess::Err() const { return ReadAll(err_); }

ProcessResult RunProcess(const std::vector<std::string>& args,
                         const std::vector<std::string>& environment,
                         std::chrono::milliseconds timeout) {
  ChildProcess process(args, environment);
  const auto exit_code = process.Wait(timeout);
  if (!exit_code) {
    throw std::runtime_error(args[0] + " still runs after " + std::to_string(timeout.count()) +
                             " ms: " + process.Out() + process.Err());
  }
  return {*exit_code, process.Out(), process.Err()};
}

}  // namespace visavis
