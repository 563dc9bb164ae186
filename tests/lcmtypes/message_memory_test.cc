#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "tests/support/malloc_counter.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/images_t.hpp"

namespace visavis {
namespace {

template <typename T>
std::vector<std::uint8_t> Encode(const T& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = static_cast<int>(bytes.size());
  EXPECT_EQ(message.encode(bytes.data(), 0, size), size);
  return bytes;
}

images_t Pair(int size) {
  images_t pair{};
  pair.n_images = 2;
  pair.image_types = {images_t::LEFT, images_t::RIGHT};
  pair.images.resize(2);
  for (image_t& image : pair.images) {
    image.size = size;
    image.data.assign(static_cast<std::size_t>(size), 7);
    image.nmetadata = 1;
    image.metadata = {{"a key longer than any small string holds", 3, {'1', '2', '3'}}};
  }
  return pair;
}

TEST(MessageMemoryTest, ReusedMessageDecodesWithoutAllocating) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  const auto bytes = Encode(Pair(1000)), shorter = Encode(Pair(900));
  images_t message;
  ASSERT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())), bytes.size());
  const auto before = NumMallocs();
  ASSERT_EQ(message.decode(shorter.data(), 0, static_cast<int>(shorter.size())), shorter.size());
  ASSERT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())), bytes.size());
  EXPECT_EQ(NumMallocs(), before);
}

TEST(MessageMemoryTest, AVectorThatShrinksToNothingIsEmptied) {
  arm_state_t message{};
  message.num_joints = 1;
  message.joint_names = {"a"};
  message.joint_position = message.joint_velocity = {1.0};
  const auto bytes = Encode(arm_state_t{});
  ASSERT_EQ(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())), bytes.size());
  EXPECT_TRUE(message.joint_position.empty());
}

TEST(MessageMemoryTest, EncoderRefusesAVectorShorterThanItsCount) {
  arm_state_t message{};
  message.num_joints = 2;
  message.joint_names = {"a", "b"};
  message.joint_position = {1.0, 2.0};
  message.joint_velocity = {1.0};
  std::vector<std::uint8_t> bytes(1000);
  EXPECT_EQ(message.encode(bytes.data(), 0, 1000), -1);
  message.joint_velocity = {1.0, 2.0};
  EXPECT_GT(message.encode(bytes.data(), 0, 1000), 0);
  message.joint_names = {"a"};
  EXPECT_EQ(message.encode(bytes.data(), 0, 1000), -1);
  EXPECT_GT(message.getEncodedSize(), 0);

  images_t pair = Pair(10);
  pair.images.resize(1);
  EXPECT_EQ(pair.encode(bytes.data(), 0, 1000), -1);
  EXPECT_GT(pair.getEncodedSize(), 0);
}

// GCC 12 at -O2 reads the old value here through stock lcm_coretypes.h.
TEST(MessageMemoryTest, NumbersWrittenJustBeforeEncodingAreEncoded) {
  double value[1] = {0};
  std::uint8_t bytes[8] = {};
  value[0] = 1.5;
  visavis_lcm_hardening::EncodeFloats(bytes, 0, 8, value, 1);
  value[0] = 2.5;
  EXPECT_EQ(bytes[0], 0x3f);
  EXPECT_EQ(bytes[1], 0xf8);
  visavis_lcm_hardening::DecodeFloats(bytes, 0, 8, value, 1);
  EXPECT_EQ(value[0], 1.5);
  EXPECT_EQ(visavis_lcm_hardening::EncodeFloats(bytes, 0, 7, value, 1), -1);
  EXPECT_EQ(visavis_lcm_hardening::DecodeFloats(bytes, 0, 7, value, 1), -1);
}

}  // namespace
}  // namespace visavis
