#pragma once

#include <CLI/CLI.hpp>
#include <iosfwd>

namespace visavis {

/// Parses a tool's arguments, which runs the callbacks that do its work, and returns the exit code:
/// 0 done, 1 failed on the way (std::exception), 2 bad flags or input (std::invalid_argument). What
/// went wrong goes to @p err as one line "NAME: what".
int RunTool(CLI::App* app, int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace visavis
