#pragma once

#include <string>

#include "common/config/rule.h"

namespace visavis {

/// Configuration of the logger; see logger.yaml.
struct LoggerConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit(
        "folder", &folder,
        Rule<std::string>{[](const std::string& v) { return !v.empty(); }, "must name a folder"});
    a->Visit("name", &name, FileStem());
    a->Visit("include", &include, RegularExpression());
    a->Visit("exclude", &exclude, RegularExpression());
    a->Visit("images", &images, OneOf({"all", "jpeg", "none"}));
    a->Visit("flush_ms", &flush_ms, InRange(10, 60'000, "ms"));
    a->Visit("min_free_mb", &min_free_mb, InRange(0, 1'000'000'000, "MB"));
    a->Visit("queue_capacity", &queue_capacity, InRange(1, 100'000));
  }
  /// @throws FieldError naming key, value and rule.
  void ValidateOrThrow() const {}

  /// One or more letters, digits, '.', '_' and '-'.
  static Rule<std::string> FileStem();
  static Rule<std::string> RegularExpression();

  std::string folder{"logs"};
  std::string name{"visavis"};
  std::string include{".*"};
  std::string exclude;
  std::string images{"all"};
  int flush_ms{1000};
  int min_free_mb{500};
  int queue_capacity{300};
};

}  // namespace visavis
