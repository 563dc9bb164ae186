#pragma once

#include <stdexcept>
#include <string>

namespace visavis {

/// A wrong configuration: one line with place (file and line, or --set), key, value and rule.
class ConfigError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Thrown by a configuration's ValidateOrThrow() for a rule between several keys; the loader adds
/// the place of @p key (dotted from the root, e.g. search.min_z_mm).
class FieldError : public std::invalid_argument {
 public:
  FieldError(const std::string& key, const std::string& value, const std::string& rule)
      : std::invalid_argument(key + ": " + value + ": " + rule),
        key_(key),
        value_(value),
        rule_(rule) {}

  const std::string& key() const { return key_; }
  const std::string& value() const { return value_; }
  const std::string& rule() const { return rule_; }

 private:
  std::string key_, value_, rule_;
};

}  // namespace visavis
