#pragma once

#include <yaml-cpp/yaml.h>

#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/config/config_error.h"
#include "common/config/rule.h"

namespace visavis {

/// Where configuration comes from: a YAML file, then --set KEY=VALUE on top.
class ConfigSource {
 public:
  /// Empty @p filename: nothing but the overrides. @throws ConfigError for a file that is missing
  /// or is no YAML mapping, and for an override without '='.
  ConfigSource(const std::string& filename, const std::vector<std::string>& overrides);

  /// From YAML text; @p name stands for it in errors.
  static ConfigSource FromText(const std::string& text, const std::string& name);

  const YAML::Node& root() const { return root_; }
  const std::string& filename() const { return filename_; }

  /// "file.yaml:12" or "--set key=value" for a dotted key; the file's name where it is in neither.
  std::string PlaceOf(const std::string& dotted_key) const;

  /// The file that @p dotted_key names by @p name: relative to the folder of the YAML file that
  /// says so, so that both move together; of --set: to where the program runs.
  std::string FileOf(const std::string& dotted_key, const std::string& name) const;

 private:
  ConfigSource() = default;
  void Parse(const std::string& text);
  const std::string* FlagOf(const std::string& dotted_key) const;  // null: no --set gave it
  void Override(const std::string& assignment);

  std::string filename_;
  YAML::Node root_;
  std::map<std::string, std::string> overrides_;  // dotted key to the flag's text
};

/// Visitor that fills a struct from one mapping: `template <class A> void Serialize(A* a)` calls
/// a->Visit(key, &member[, rule]). A missing key keeps its default; an unknown key, a key given
/// twice, a value of the wrong type or one that breaks its rule is a ConfigError. A vector of such
/// structs is a list of mappings; its members' keys read "list.0.key".
class ConfigReader {
 public:
  ConfigReader(const ConfigSource& source, const YAML::Node& node, std::string prefix)
      : source_(source), node_(node), prefix_(std::move(prefix)) {}

  template <typename T>
  void Visit(const std::string& key, T* value) {
    VisitIf<T>(key, value, nullptr);
  }
  template <typename T>
  void Visit(const std::string& key, T* value, const Rule<T>& rule) {
    VisitIf(key, value, &rule);
  }

  /// As Visit(), of a file or folder that is read; see ConfigSource::FileOf().
  void VisitFile(const std::string& key, std::string* name) {
    const bool is_given = node_.IsDefined() && node_.IsMap() && node_[key].IsDefined();
    Visit(key, name);
    if (is_given) *name = source_.FileOf(prefix_ + key, *name);
  }

  /// To be called after the last Visit. @throws ConfigError naming the first key that is unknown or
  /// given twice.
  void RejectUnknownKeys() const;

 private:
  template <typename T, typename = void>
  struct IsStruct : std::false_type {};
  template <typename T>
  struct IsStruct<
      T, std::void_t<decltype(std::declval<T&>().Serialize(static_cast<ConfigReader*>(nullptr)))>>
      : std::true_type {};
  template <typename T>
  struct IsStructList : std::false_type {};
  template <typename T>
  struct IsStructList<std::vector<T>> : IsStruct<T> {};

  template <typename T>
  void VisitIf(const std::string& key, T* value, const Rule<T>* rule) {
    known_.insert(key);
    if (!node_.IsDefined() || !node_.IsMap()) return;
    const YAML::Node child = node_[key];
    if (!child.IsDefined()) return;
    if constexpr (IsStruct<T>::value) {
      if (!child.IsMap()) Fail(key, child, "must be a mapping of keys");
      ConfigReader reader(source_, child, prefix_ + key + ".");
      value->Serialize(&reader);
      reader.RejectUnknownKeys();
    } else if constexpr (IsStructList<T>::value) {
      if (!child.IsSequence()) Fail(key, child, "must be a list of mappings");
      value->clear();
      for (std::size_t i = 0; i < child.size(); ++i) {
        const std::string item = key + "." + std::to_string(i);
        if (!child[i].IsMap()) Fail(item, child[i], "must be a mapping of keys");
        ConfigReader reader(source_, child[i], prefix_ + item + ".");
        value->emplace_back().Serialize(&reader);
        reader.RejectUnknownKeys();
      }
    } else {
      try {
        *value = child.as<T>();
      } catch (const YAML::Exception&) {
        Fail(key, child, std::string("must be ") + TypeName<T>());
      }
      if (rule && !rule->holds(*value)) Fail(key, child, rule->text);
    }
  }

  template <typename T>
  static std::string TypeName() {
    if constexpr (std::is_same_v<T, bool>) return "true or false";
    if constexpr (std::is_integral_v<T>) return "a whole number in range";
    if constexpr (std::is_floating_point_v<T>) return "a number";
    if constexpr (std::is_same_v<T, std::string>) return "text";
    return "a list of the right length and type";
  }
  [[noreturn]] void Fail(const std::string& key, const YAML::Node& value,
                         const std::string& rule) const;

  const ConfigSource& source_;
  YAML::Node node_;
  std::string prefix_;
  std::set<std::string> known_;
};

/// Reads, checks and returns a configuration; ValidateOrThrow() is called where Config has one.
/// @throws ConfigError: one line with place, key, value and rule.
template <typename Config>
Config LoadConfig(const std::string& filename, const std::vector<std::string>& overrides = {}) {
  const ConfigSource source(filename, overrides);
  Config config;
  ConfigReader reader(source, source.root(), "");
  config.Serialize(&reader);
  reader.RejectUnknownKeys();
  try {
    config.ValidateOrThrow();
  } catch (const FieldError& e) {
    throw ConfigError(source.PlaceOf(e.key()) + ": " + e.what());
  }
  return config;
}

}  // namespace visavis
