#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <stdexcept>
#include <string>

#include "tests/support/lcm_schema.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// What is wrong with a field's comment; empty: nothing. A number says its unit in brackets, or the
/// enum whose values it takes; a flag says what true or false means; the rest says anything.
std::string CommentFault(const LcmField& field) {
  static const std::regex unit(R"(\[[^\]]+\].*)"), enumeration(R"(enum [A-Z_]+\b.*)"),
      flag(R"((true|false): .*)");
  if (field.comment.empty()) return "must have a comment";
  if (!IsPrimitive(field.type) || field.type == "string" || field.type == "byte") return {};
  if (field.type == "boolean") {
    return std::regex_match(field.comment, flag) ? "" : "must say what true: or false: means";
  }
  const bool good =
      std::regex_match(field.comment, unit) || std::regex_match(field.comment, enumeration);
  return good ? "" : "must begin with its [unit] or its enum";
}

/// Likewise for the range of a real number: bounds, or finite, or what NaN means.
std::string RangeFault(const LcmField& field) {
  if (field.type != "float" && field.type != "double") return {};
  static const std::regex range(R"(finite|NaN: |[<>]|\d to \d|norm 1|above .* below)");
  return std::regex_search(field.comment, range) ? "" : "must say its range and invalid value";
}

TEST(LcmFileTest, EveryStructAndFieldSaysUnitAndRange) {
  const LcmSchema schema = ReadProjectSchema();
  EXPECT_GE(schema.size(), 15u);
  for (const auto& [name, message] : schema) {
    EXPECT_NE(message.comment, "") << "lcmtypes/" << name << ".lcm: must begin with a comment";
    for (const LcmField& field : message.fields) {
      const std::string place = name + ".lcm:" + std::to_string(field.line) + ": " + field.name;
      EXPECT_EQ(CommentFault(field), "") << place;
      EXPECT_EQ(RangeFault(field), "") << place << ": " << field.comment;
    }
  }
}

TEST(LcmFileTest, AFieldWithoutUnitIsFound) {
  EXPECT_EQ(CommentFault({"double", "x", {}, "", 1}), "must have a comment");
  EXPECT_EQ(CommentFault({"double", "x", {}, "how far", 1}),
            "must begin with its [unit] or its enum");
  EXPECT_EQ(CommentFault({"boolean", "b", {}, "a flag", 1}), "must say what true: or false: means");
  EXPECT_EQ(CommentFault({"int8_t", "s", {}, "enum STATE", 1}), "");
  EXPECT_EQ(RangeFault({"double", "x", {}, "[m] how far", 1}),
            "must say its range and invalid value");
}

class ReadLcmFileTest : public ::testing::Test {
 protected:
  LcmStruct Read(const std::string& text) {
    const std::string file = ::testing::TempDir() + "/schema_test_t.lcm";
    std::ofstream(file) << text;
    return ReadLcmFile(file);
  }
};

TEST_F(ReadLcmFileTest, ReadsFieldsDimensionsAndComments) {
  const LcmStruct read = Read(
      "package p;\n\n// What it is,\n// in two lines.\nstruct a_t {\n  int32_t n;  // [-] count\n"
      "              // from 1\n  double x[n][3];\n  const int8_t A = 1, B = 2;\n}\n");
  EXPECT_EQ(read.name, "a_t");
  EXPECT_EQ(read.comment, "What it is, in two lines.");
  ASSERT_EQ(read.fields.size(), 2u);
  EXPECT_EQ(read.fields[0].comment, "[-] count from 1");
  EXPECT_EQ(read.fields[1].line, 8);
  EXPECT_THAT(read.fields[1].dims, ::testing::ElementsAre("n", "3"));
}

TEST_F(ReadLcmFileTest, NamesTheLineThatItDoesNotUnderstand) {
  EXPECT_THAT(
      [&] { Read("struct a_t {\n  int32_t a, b;\n}\n"); },
      ThrowsMessage<std::runtime_error>(HasSubstr("schema_test_t.lcm:2: '  int32_t a, b;'")));
  EXPECT_THAT([] { ReadLcmFile("/nowhere.lcm"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("/nowhere.lcm: cannot be read")));
}

}  // namespace
}  // namespace visavis
