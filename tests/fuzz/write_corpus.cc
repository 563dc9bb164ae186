// write_corpus LCMTYPES_FOLDER CORPUS_FOLDER: writes the named nasty messages of every type (see
// the corpus's README). Run it again where a type has come or changed.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/fuzz/wire_message.h"

namespace visavis {
namespace {

class Folder {
 public:
  explicit Folder(const std::filesystem::path& path) : path_(path) {
    std::filesystem::create_directories(path);
  }
  /// Without the fingerprint, which changes with the type.
  void Write(const std::string& name, const Bytes& bytes) const {
    std::ofstream file(path_ / (name + ".bin"), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()) + 8,
               static_cast<std::streamsize>(bytes.size()) - 8);
  }

 private:
  const std::filesystem::path path_;
};

/// The message's first count, or its first string's length; null: none.
const WireLength* FindLength(const WireMessage& message, bool is_string) {
  for (const WireLength& length : message.lengths) {
    if (length.is_string == is_string) return &length;
  }
  return nullptr;
}

void WriteLies(const Folder& folder, const std::string& what, const WireLength& length,
               const Bytes& valid) {
  const auto write = [&](const std::string& name, std::int64_t value) {
    Bytes bytes = valid;
    SetLength(length, value, &bytes);
    folder.Write("refused_" + what + "_" + name, bytes);
  };
  write("minus_one", -1);
  write("least", std::numeric_limits<std::int64_t>::min() >> (64 - 8 * length.num_bytes));
  write("largest", std::numeric_limits<std::int64_t>::max() >> (64 - 8 * length.num_bytes));
  if (length.is_string) write("zero", 0);
}

void WriteType(const LcmSchema& schema, const std::string& type, const Folder& folder) {
  Random random(1);
  folder.Write("accepted_smallest", RandomWireMessage(schema, type, 0, &random).bytes);
  WireMessage message = RandomWireMessage(schema, type, 3, &random);
  // One with something in its first array.
  while (FindLength(message, false) != nullptr &&
         GetLength(*FindLength(message, false), message.bytes) == 0) {
    message = RandomWireMessage(schema, type, 3, &random);
  }
  const Bytes& valid = message.bytes;
  folder.Write("accepted_random", valid);
  folder.Write("refused_empty", Bytes(8));
  folder.Write("refused_truncated", Bytes(valid.begin(), valid.end() - 1));
  Bytes longer = valid;
  longer.push_back(0);
  folder.Write("refused_trailing_byte", longer);
  folder.Write(message.lengths.empty() ? "accepted_all_ff" : "refused_all_ff",
               Bytes(valid.size(), 0xff));
  if (const WireLength* count = FindLength(message, false)) {
    WriteLies(folder, "count", *count, valid);
  }
  if (const WireLength* length = FindLength(message, true)) {
    WriteLies(folder, "string", *length, valid);
    const std::size_t nul = length->offset + 4 + GetLength(*length, valid) - 1;
    Bytes bytes = valid;
    bytes[nul] = 'x';
    folder.Write("refused_string_without_nul", bytes);
    if (GetLength(*length, valid) < 2) return;
    bytes[nul] = 0;
    bytes[nul - 1] = 0;
    folder.Write("refused_string_with_inner_nul", bytes);
  }
}

}  // namespace
}  // namespace visavis

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: write_corpus LCMTYPES_FOLDER CORPUS_FOLDER\n");
    return 2;
  }
  try {
    const visavis::LcmSchema schema = visavis::ReadLcmFolder(argv[1]);
    for (const auto& [type, declared] : schema) {
      visavis::WriteType(schema, type, visavis::Folder(std::filesystem::path(argv[2]) / type));
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "write_corpus: %s\n", e.what());
    return 1;
  }
  return 0;
}
