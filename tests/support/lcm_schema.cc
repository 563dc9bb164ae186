#include "tests/support/lcm_schema.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace visavis {
namespace {

const std::map<std::string, int> kPrimitiveSizes = {{"int8_t", 1},  {"byte", 1},    {"boolean", 1},
                                                    {"int16_t", 2}, {"int32_t", 4}, {"float", 4},
                                                    {"string", 5},  {"double", 8},  {"int64_t", 8}};

const LcmStruct& Find(const LcmSchema& schema, const std::string& type) {
  const auto found = schema.find(type);
  if (found == schema.end()) throw std::runtime_error("type " + type + ": must have a .lcm file");
  return found->second;
}

bool IsNumber(const std::string& text) {
  return text.find_first_not_of("0123456789") == std::string::npos;
}

std::int64_t HashByte(std::int64_t hash, char byte) {
  const auto bits = static_cast<std::uint64_t>(hash);
  return static_cast<std::int64_t>(((bits << 8) ^ static_cast<std::uint64_t>(hash >> 55)) +
                                   static_cast<std::uint64_t>(byte));
}

std::int64_t HashString(std::int64_t hash, const std::string& text) {
  hash = HashByte(hash, static_cast<char>(text.size()));
  for (const char c : text) hash = HashByte(hash, c);
  return hash;
}

std::vector<std::string> Dimensions(const std::string& brackets) {
  static const std::regex dimension(R"(\[(\w+)\])");
  std::vector<std::string> result;
  for (std::sregex_iterator it(brackets.begin(), brackets.end(), dimension), end; it != end; ++it) {
    result.push_back((*it)[1]);
  }
  return result;
}

}  // namespace

LcmStruct ReadLcmFile(const std::string& file) {
  static const std::regex kOther(R"(\s*|package \w+;|\}|\s*const .*;\s*(//.*)?)");
  static const std::regex kComment(R"(\s*//\s*(.*))");
  static const std::regex kStruct(R"(struct (\w+) \{)");
  static const std::regex kField(R"(\s*(\w+) (\w+)((\[\w+\])*);\s*(//\s*(.*))?)");
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": cannot be read");
  LcmStruct result;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::smatch match;
    if (std::regex_match(line, match, kComment)) {
      std::string& comment = result.fields.empty() ? result.comment : result.fields.back().comment;
      comment += (comment.empty() ? "" : " ") + match[1].str();
    } else if (std::regex_match(line, match, kStruct)) {
      result.name = match[1];
    } else if (std::regex_match(line, kOther)) {
      continue;
    } else if (std::regex_match(line, match, kField)) {
      result.fields.push_back({match[1], match[2], Dimensions(match[3]), match[6], number});
    } else {
      std::ostringstream what;
      what << file << ":" << number << ": '" << line
           << "': must be a comment, a constant or one field";
      throw std::runtime_error(what.str());
    }
  }
  if (result.name.empty()) throw std::runtime_error(file + ": must have a struct");
  return result;
}

LcmSchema ReadLcmFolder(const std::string& folder) {
  LcmSchema schema;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".lcm") continue;
    LcmStruct read = ReadLcmFile(entry.path());
    if (read.name != entry.path().stem()) {
      throw std::runtime_error(entry.path().string() + ": struct " + read.name +
                               ": must be named like its file");
    }
    schema[read.name] = std::move(read);
  }
  return schema;
}

LcmSchema ReadProjectSchema() {
  const char* source = std::getenv("VISAVIS_SOURCE_DIR");
  if (source == nullptr) throw std::runtime_error("VISAVIS_SOURCE_DIR: must be set; ctest sets it");
  return ReadLcmFolder(std::string(source) + "/lcmtypes");
}

bool IsPrimitive(const std::string& type) { return kPrimitiveSizes.count(type) > 0; }

std::int64_t Fingerprint(const LcmSchema& schema, const std::string& type) {
  const LcmStruct& message = Find(schema, type);
  std::int64_t hash = 0x12345678;
  for (const LcmField& field : message.fields) {
    hash = HashString(hash, field.name);
    if (IsPrimitive(field.type)) hash = HashString(hash, field.type);
    hash = HashByte(hash, static_cast<char>(field.dims.size()));
    for (const std::string& dim : field.dims) {
      hash = HashByte(hash, IsNumber(dim) ? 0 : 1);
      hash = HashString(hash, dim);
    }
  }
  auto sum = static_cast<std::uint64_t>(hash);
  for (const LcmField& field : message.fields) {
    if (!IsPrimitive(field.type))
      sum += static_cast<std::uint64_t>(Fingerprint(schema, field.type));
  }
  return static_cast<std::int64_t>((sum << 1) | (sum >> 63));
}

int MinEncodedSize(const LcmSchema& schema, const std::string& type) {
  if (IsPrimitive(type)) return kPrimitiveSizes.at(type);
  int size = 0;
  for (const LcmField& field : Find(schema, type).fields) {
    int count = 1;
    for (const std::string& dim : field.dims) count *= IsNumber(dim) ? std::stoi(dim) : 0;
    size += count * MinEncodedSize(schema, field.type);
  }
  return size;
}

}  // namespace visavis
