#pragma once

#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace visavis {

/// What one configured value must fulfil, and how the rule reads in an error line.
template <typename T>
struct Rule {
  std::function<bool(const T&)> holds;
  std::string text;
};

/// min <= value <= max; NaN fails.
template <typename T>
Rule<T> InRange(T min, T max, const std::string& unit = "") {
  std::ostringstream text;
  text << "must be " << min << " to " << max << (unit.empty() ? "" : " " + unit);
  return {[min, max](const T& v) { return v >= min && v <= max; }, text.str()};
}

/// One of the given words.
inline Rule<std::string> OneOf(const std::vector<std::string>& words) {
  std::string text = "must be one of";
  for (const auto& word : words) text += " " + (word.empty() ? "''" : word);
  return {[words](const std::string& v) {
            for (const auto& word : words) {
              if (v == word) return true;
            }
            return false;
          },
          text};
}

/// A literal LCM channel: A-Z, 0-9 and _, at most 63 characters.
Rule<std::string> ChannelName();

/// As ChannelName, or empty: a prefix of channels.
Rule<std::string> ChannelPrefix();

}  // namespace visavis
