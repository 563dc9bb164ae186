#pragma once

#include <string>

namespace visavis {

/// Runs gnuplot on a script (by way of @p script_file, which goes afterwards) and waits for it.
/// @throws std::runtime_error where it fails or is not installed.
void RunGnuplot(const std::string& script, const std::string& script_file);

/// A text as a gnuplot string constant.
std::string QuoteForGnuplot(const std::string& text);

}  // namespace visavis
