#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "tests/fuzz/decode_check.h"
#include "tests/fuzz/wire_message.h"

namespace visavis {
namespace {

constexpr int kMutations = 4000;

std::string Hex(const Bytes& bytes) {
  std::string text;
  char digits[3];
  for (const std::uint8_t byte : bytes) {
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
    if (text.size() > 1000) return text + "...";
  }
  return text;
}

/// Every type of the list, so a new one too.
template <typename T>
class DecoderFuzzTest : public ::testing::Test {
 protected:
  WireMessage Valid() { return RandomWireMessage(schema_, T::getTypeName(), 3, &random_); }
  DecodeVerdict Check(const Bytes& input) {
    const DecodeVerdict verdict = CheckDecode(input, &reused_);
    EXPECT_EQ(verdict.fault, "") << T::getTypeName() << " from " << Hex(input);
    return verdict;
  }

  const LcmSchema schema_ = ReadProjectSchema();
  Random random_{20240607};
  T reused_{};
};
TYPED_TEST_SUITE(DecoderFuzzTest, AllTypes<::testing::Types>);

TYPED_TEST(DecoderFuzzTest, AcceptsValidMessages) {
  for (int i = 0; i < 100; ++i) {
    const Bytes bytes = this->Valid().bytes;
    ASSERT_TRUE(this->Check(bytes).accepted) << Hex(bytes);
  }
}

TYPED_TEST(DecoderFuzzTest, RefusesEachTruncationAndTrailingBytes) {
  Bytes bytes = this->Valid().bytes;
  bytes.push_back(0);
  EXPECT_FALSE(this->Check(bytes).accepted);
  bytes.pop_back();
  EXPECT_TRUE(this->Check(bytes).accepted);
  while (!bytes.empty()) {
    bytes.pop_back();
    ASSERT_FALSE(this->Check(bytes).accepted) << bytes.size() << " bytes";
  }
}

TYPED_TEST(DecoderFuzzTest, SurvivesMutations) {
  int num_accepted = 0;
  for (int i = 0; i < kMutations && !this->HasFailure(); ++i) {
    num_accepted += this->Check(Mutate(this->Valid(), &this->random_)).accepted;
  }
  this->RecordProperty("accepted", num_accepted);
  // Neither would test much: refusing everything at the first byte, or never meeting a lie.
  EXPECT_GT(num_accepted, kMutations / 50);
  EXPECT_LT(num_accepted, kMutations * 9 / 10);
}

TYPED_TEST(DecoderFuzzTest, GreediestLengthsStayWithinTheAllocationLimit) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  constexpr int kBytes = 300000;
  double worst = 0;
  for (const Bytes& bytes : Greediest(this->Valid(), kBytes)) {
    const DecodeVerdict verdict = this->Check(bytes);
    worst = std::max(worst, static_cast<double>(verdict.allocated_bytes) / kBytes);
  }
  // The limit's constant part would hide much here.
  EXPECT_LT(worst, 16) << "times the input";
  this->RecordProperty("allocated_per_input_byte", std::to_string(worst));
}

}  // namespace
}  // namespace visavis
