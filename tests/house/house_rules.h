#pragma once

#include <string>
#include <vector>

namespace visavis {

/// One place that breaks a rule of the house.
struct Violation {
  std::string file;  ///< relative to the checkout
  int line{0};       ///< from 1
  std::string rule;  ///< what is there and what must be
};

/// "FILE:LINE: RULE", one a line.
std::string ToText(const std::vector<Violation>& violations);

/// One line of include_rules.txt.
struct IncludeRule {
  std::string pattern;
  std::vector<std::string> words;
};

/// Reads include_rules.txt, which explains itself. @throws std::runtime_error.
std::vector<IncludeRule> ReadIncludeRules(const std::string& file);

/// C++ text without the insides of comments, strings and characters; every line stays in its place.
std::string StripCommentsAndStrings(const std::string& text);

/// Includes of @p file (relative, with / between) against the rules.
std::vector<Violation> CheckIncludes(const std::string& file, const std::string& text,
                                     const std::vector<IncludeRule>& rules);

/// A library neither prints nor ends the process nor asserts; main.cc and what it calls may print.
std::vector<Violation> CheckPrintsAndExits(const std::string& file, const std::string& text);

/// No file is longer than 400 lines.
std::vector<Violation> CheckLength(const std::string& file, const std::string& text);

}  // namespace visavis
