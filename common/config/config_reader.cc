#include "common/config/config_reader.h"

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace visavis {
namespace {

bool IsChannelCharacter(unsigned char c) { return std::isupper(c) || std::isdigit(c) || c == '_'; }

bool IsChannel(const std::string& name) {
  return name.size() <= 63 && std::all_of(name.begin(), name.end(), IsChannelCharacter);
}

std::vector<std::string> SplitDotted(const std::string& key) {
  std::vector<std::string> parts{""};
  for (const char c : key) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::string OneLine(const YAML::Node& node) {
  if (node.IsNull()) return "empty";
  std::string text = node.IsScalar() ? node.Scalar() : YAML::Dump(node);
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.size() > 80) text = text.substr(0, 77) + "...";
  return text;
}

std::string ReadText(const std::string& filename) {
  try {
    std::ifstream file(filename, std::ios::binary);
    if (!file) throw ConfigError(filename + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  } catch (const std::ios_base::failure&) {  // a folder opens, and then fails
    throw ConfigError(filename + ": cannot be read");
  }
}

// Takes a document and keeps nothing.
class SkipDocument : public YAML::EventHandler {
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

// Whether there is text behind the first document, which YAML::Load() leaves out in silence.
// (YAML::LoadAll() does not come back from ",a]b:".)
bool HasSecondDocument(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  SkipDocument skip;
  return parser.HandleNextDocument(skip) && parser.HandleNextDocument(skip);
}

}  // namespace

Rule<std::string> ChannelName() {
  return {[](const std::string& v) { return !v.empty() && IsChannel(v); },
          "must be 1 to 63 characters of A-Z, 0-9 and _"};
}

Rule<std::string> ChannelPrefix() {
  return {[](const std::string& v) { return IsChannel(v); },
          "must be at most 63 characters of A-Z, 0-9 and _"};
}

ConfigSource::ConfigSource(const std::string& filename, const std::vector<std::string>& overrides)
    : filename_(filename) {
  if (!filename.empty()) Parse(ReadText(filename));
  if (!root_.IsMap()) root_ = YAML::Node(YAML::NodeType::Map);
  for (const auto& assignment : overrides) Override(assignment);
}

ConfigSource ConfigSource::FromText(const std::string& text, const std::string& name) {
  ConfigSource source;
  source.filename_ = name;
  source.Parse(text);
  return source;
}

void ConfigSource::Parse(const std::string& text) {
  try {
    root_ = YAML::Load(text);
    if (HasSecondDocument(text)) throw ConfigError(filename_ + ": must be one YAML document");
  } catch (const YAML::Exception& e) {
    throw ConfigError(filename_ + ":" + std::to_string(e.mark.line + 1) + ": is no YAML: " + e.msg);
  }
  if (!root_.IsMap() && !root_.IsNull())
    throw ConfigError(filename_ + ":1: must be a mapping of keys");
}

void ConfigSource::Override(const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw ConfigError("--set " + assignment + ": must read KEY=VALUE");
  }
  const std::string key = assignment.substr(0, equals);
  YAML::Node value;
  try {
    value = YAML::Load(assignment.substr(equals + 1));
  } catch (const YAML::ParserException& e) {
    throw ConfigError("--set " + assignment + ": value is no YAML: " + e.msg);
  }
  // Each level of a YAML::Node aliases the tree; reset() rebinds without assigning.
  YAML::Node level;
  level.reset(root_);
  const auto parts = SplitDotted(key);
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    YAML::Node child = level[parts[i]];
    if (child.IsDefined() && !child.IsMap()) {
      throw ConfigError("--set " + assignment + ": " + parts[i] + " is no mapping");
    }
    if (!child.IsDefined()) child = YAML::Node(YAML::NodeType::Map);
    level.reset(child);
  }
  level[parts.back()] = value;
  overrides_[key] = "--set " + assignment;
}

const std::string* ConfigSource::FlagOf(const std::string& dotted_key) const {
  for (const auto& [key, flag] : overrides_) {
    if (key == dotted_key || key.rfind(dotted_key + ".", 0) == 0 ||
        dotted_key.rfind(key + ".", 0) == 0) {
      return &flag;
    }
  }
  return nullptr;
}

std::string ConfigSource::FileOf(const std::string& dotted_key, const std::string& name) const {
  if (name.empty() || FlagOf(dotted_key)) return name;
  return std::filesystem::path(filename_).parent_path() / name;
}

std::string ConfigSource::PlaceOf(const std::string& dotted_key) const {
  if (const std::string* flag = FlagOf(dotted_key)) return *flag;
  YAML::Node node;
  node.reset(root_);
  int line = -1;
  for (const auto& part : SplitDotted(dotted_key)) {
    if (!node.IsMap()) break;
    for (const auto& entry : node) {
      if (entry.first.Scalar() == part) line = entry.first.Mark().line;
    }
    const YAML::Node child = static_cast<const YAML::Node&>(node)[part];
    if (!child.IsDefined()) break;
    node.reset(child);
  }
  if (filename_.empty()) return "configuration";
  return line < 0 ? filename_ : filename_ + ":" + std::to_string(line + 1);
}

void ConfigReader::RejectUnknownKeys() const {
  if (!node_.IsMap()) return;
  std::set<std::string> seen;
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (!seen.insert(key).second) Fail(key, entry.second, "must not be given twice");
    if (known_.count(key)) continue;
    std::string known;
    for (const auto& name : known_) known += " " + name;
    Fail(key, entry.second, "unknown key, must be one of" + known);
  }
}

void ConfigReader::Fail(const std::string& key, const YAML::Node& value,
                        const std::string& rule) const {
  throw ConfigError(source_.PlaceOf(prefix_ + key) + ": " + prefix_ + key + ": " + OneLine(value) +
                    ": " + rule);
}

}  // namespace visavis
