#include "services/evaluate/gnuplot.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "common/core/provisional_file.h"

namespace visavis {
namespace {

/// The environment with a locale that knows UTF-8, which our scripts are in: a bare system has
/// none, and gnuplot warns of each sign that it cannot convert.
std::vector<std::string> Utf8Environment() {
  std::vector<std::string> result{"LC_ALL=C.UTF-8"};
  for (char** variable = environ; *variable; ++variable) {
    if (std::strncmp(*variable, "LC_ALL=", 7) != 0) result.emplace_back(*variable);
  }
  return result;
}

}  // namespace

void RunGnuplot(const std::string& script, const std::string& script_file) {
  WriteTextFile(script_file, script);
  std::string program = "gnuplot", file = script_file;
  char* argv[] = {program.data(), file.data(), nullptr};
  std::vector<std::string> environment = Utf8Environment();
  std::vector<char*> envp;
  envp.reserve(environment.size() + 1);
  for (auto& variable : environment) envp.push_back(variable.data());
  envp.push_back(nullptr);
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, "gnuplot", nullptr, nullptr, argv, envp.data());
  int status = 0;
  while (error == 0 && waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  std::remove(script_file.c_str());
  if (error != 0) {
    throw std::runtime_error(std::string("gnuplot: ") + std::strerror(error) +
                             ": 'sudo apt install gnuplot-nox' brings it");
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error("gnuplot failed on the figures, status " + std::to_string(status));
  }
}

std::string QuoteForGnuplot(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += '\'';  // doubled inside single quotes
    if (static_cast<unsigned char>(c) >= ' ') quoted += c;
  }
  return quoted + "'";
}

}  // namespace visavis
