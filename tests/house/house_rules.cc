#include "tests/house/house_rules.h"

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace visavis {
namespace {

constexpr int kMaxLines = 400;

bool StartsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool Fits(const std::string& pattern, const std::string& file) {
  return fnmatch(pattern.c_str(), file.c_str(), 0) == 0;
}

std::string Folder(const std::string& file) { return file.substr(0, file.rfind('/') + 1); }

/// C++'s own: a name in angle brackets without slash or ending.
bool IsStandard(const std::string& header) {
  return header.front() == '<' && header.find_first_of("/.") == std::string::npos;
}

bool IsPosix(const std::string& header) {
  static const std::regex posix(
      R"(<((arpa|net|netinet|sys|linux)/\w+|dirent|fcntl|fnmatch|glob|poll|pwd|sched|signal|spawn|time|unistd)\.h>)");
  return std::regex_match(header, posix);
}

/// Whether one word of a rule allows @p header (with its quotes or angle brackets).
bool Allows(std::string word, const std::string& file, const std::string& header) {
  if (StartsWith(word, "cc:")) {
    if (file.size() < 3 || file.substr(file.size() - 3) != ".cc") return false;
    word = word.substr(3);
  }
  const std::string name = header.substr(1, header.size() - 2);
  static const std::regex message(R"(visavis/\w+_t\.hpp)");
  if (word == "posix") return IsPosix(header);
  if (word == "types") return std::regex_match(name, message);
  if (StartsWith(name, "common/" + word + "/")) return true;
  const bool is_path = word.find_first_of("/.") != std::string::npos;
  return is_path && (StartsWith(name, word) || StartsWith(name, "common/" + word));
}

bool IsAllowed(const IncludeRule& rule, const std::string& file, const std::string& header) {
  const std::string name = header.substr(1, header.size() - 2);
  for (const std::string& word : rule.words) {
    if (word == "no:" + header || word == "no:" + name) return false;
  }
  if (IsStandard(header) || StartsWith(name, Folder(file))) return true;
  return std::any_of(rule.words.begin(), rule.words.end(),
                     [&](const std::string& word) { return Allows(word, file, header); });
}

/// Where the comment, string or character that begins at @p at ends; @p at itself: none begins
/// there.
std::size_t EndOfQuiet(const std::string& text, std::size_t at) {
  const auto behind = [&](const std::string& end, std::size_t from) {
    const std::size_t found = text.find(end, from);
    return found == std::string::npos ? text.size() : found + end.size();
  };
  if (text.compare(at, 2, "//") == 0) return std::min(text.find('\n', at), text.size());
  if (text.compare(at, 2, "/*") == 0) return behind("*/", at + 2);
  if (text.compare(at, 2, "R\"") == 0) {
    const std::size_t open = text.find('(', at);
    if (open == std::string::npos) return text.size();
    return behind(")" + text.substr(at + 2, open - at - 2) + "\"", open);
  }
  const char quote = text[at];
  const bool in_number = quote == '\'' && at > 0 && std::isalnum(text[at - 1]) != 0;
  if ((quote != '"' && quote != '\'') || in_number) return at;
  for (std::size_t i = at + 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == quote || text[i] == '\n') {
      return i + (text[i] == quote);
    }
  }
  return text.size();
}

/// Calls @p visit with each line and its number.
template <typename Visit>
void ForEachLine(const std::string& text, Visit visit) {
  std::istringstream in(text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) visit(number, line);
}

}  // namespace

std::string ToText(const std::vector<Violation>& violations) {
  std::string text;
  for (const Violation& v : violations) {
    text += v.file + ":" + std::to_string(v.line) + ": " + v.rule + "\n";
  }
  return text;
}

std::vector<IncludeRule> ReadIncludeRules(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": cannot be read");
  std::vector<IncludeRule> rules;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    IncludeRule rule;
    if (!(words >> rule.pattern)) continue;
    for (std::string word; words >> word;) rule.words.push_back(word);
    rules.push_back(rule);
  }
  return rules;
}

std::string StripCommentsAndStrings(const std::string& text) {
  std::string result;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = EndOfQuiet(text, at);
    if (end == at) {
      result += text[at++];
      continue;
    }
    const auto from = text.begin() + static_cast<std::ptrdiff_t>(at);
    const auto to = text.begin() + static_cast<std::ptrdiff_t>(end);
    result.append(static_cast<std::size_t>(std::count(from, to, '\n')), '\n');
    at = end;
  }
  return result;
}

std::vector<Violation> CheckIncludes(const std::string& file, const std::string& text,
                                     const std::vector<IncludeRule>& rules) {
  static const std::regex include(R"(\s*#\s*include\s*(["<][^">]+[">]).*)");
  const auto rule = std::find_if(rules.begin(), rules.end(), [&](const IncludeRule& candidate) {
    return Fits(candidate.pattern, file);
  });
  if (rule == rules.end()) return {{file, 1, "no line of include_rules.txt fits this file"}};
  std::vector<Violation> violations;
  ForEachLine(text, [&](int number, const std::string& line) {
    std::smatch match;
    if (!std::regex_match(line, match, include) || IsAllowed(*rule, file, match[1])) return;
    violations.push_back({file, number,
                          "includes " + match[1].str() + ": " + rule->pattern +
                              " may not (tests/house/include_rules.txt)"});
  });
  return violations;
}

std::vector<Violation> CheckPrintsAndExits(const std::string& file, const std::string& text) {
  static const std::regex bad(
      R"((^|[^\w.>])(printf|fprintf|vprintf|puts|fputs|putchar|perror|exit|_exit|_Exit|quick_exit|abort|assert|terminate)\s*\(|std::(cout|cerr|clog)\b)");
  // What every main() calls may print, flags' help and errors too.
  for (const char* main :
       {"services/*/main.cc", "services/*_main.cc", "common/service/run_service.cc",
        "common/service/service_flags.cc", "common/tool/run_tool.cc"}) {
    if (Fits(main, file)) return {};
  }
  std::vector<Violation> violations;
  ForEachLine(StripCommentsAndStrings(text), [&](int number, const std::string& line) {
    std::smatch match;
    if (!std::regex_search(line, match, bad)) return;
    const std::string what = match[2].matched ? match[2].str() : match[0].str();
    violations.push_back(
        {file, number, what + ": a library neither prints nor ends the process nor asserts"});
  });
  return violations;
}

std::vector<Violation> CheckLength(const std::string& file, const std::string& text) {
  const auto lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  if (lines <= kMaxLines) return {};
  return {{file, lines,
           "is " + std::to_string(lines) + " lines long: must be at most " +
               std::to_string(kMaxLines)}};
}

}  // namespace visavis
