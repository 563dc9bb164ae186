#pragma once

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <string>
#include <type_traits>
#include <vector>

#include "common/config/rule.h"

namespace visavis {

/// Visitor that writes a configuration as YAML: the counterpart of ConfigReader, for
/// --print-config and for the tests that hold shipped files against the defaults.
class ConfigWriter {
 public:
  template <typename T>
  void Visit(const std::string& key, T* value) {
    if constexpr (HasSerialize<T>::value) {
      ConfigWriter writer;
      value->Serialize(&writer);
      node_[key] = writer.node_;
    } else {
      node_[key] = Plain(*value);
    }
  }
  template <typename T>
  void Visit(const std::string& key, T* value, const Rule<T>&) {
    Visit(key, value);
  }
  void VisitFile(const std::string& key, std::string* name) { Visit(key, name); }

  const YAML::Node& node() const { return node_; }

 private:
  template <typename T, typename = void>
  struct HasSerialize : std::false_type {};
  template <typename T>
  struct HasSerialize<
      T, std::void_t<decltype(std::declval<T&>().Serialize(static_cast<ConfigWriter*>(nullptr)))>>
      : std::true_type {};
  template <typename T>
  struct IsStructList : std::false_type {};
  template <typename T>
  struct IsStructList<std::vector<T>> : HasSerialize<T> {};

  // A number by its shortest text that reads back the same.
  static std::string Plain(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
  }
  static YAML::Node Plain(const std::vector<double>& values) {
    YAML::Node list(YAML::NodeType::Sequence);
    for (const double value : values) list.push_back(Plain(value));
    list.SetStyle(YAML::EmitterStyle::Flow);
    return list;
  }
  template <typename T>
  static auto Plain(const std::vector<T>& values)
      -> std::enable_if_t<HasSerialize<T>::value, YAML::Node> {
    YAML::Node list(YAML::NodeType::Sequence);
    for (T value : values) {
      ConfigWriter writer;
      value.Serialize(&writer);
      list.push_back(writer.node_);
    }
    return list;
  }
  template <typename T>
  static auto Plain(const T& value) -> std::enable_if_t<!IsStructList<T>::value, const T&> {
    return value;
  }

  YAML::Node node_{YAML::NodeType::Map};
};

/// The whole configuration as YAML text.
template <typename Config>
std::string DumpConfig(Config config) {
  ConfigWriter writer;
  config.Serialize(&writer);
  return YAML::Dump(writer.node());
}

}  // namespace visavis
