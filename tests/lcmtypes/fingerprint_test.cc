#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "elsewhere/transform_t.hpp"
#include "tests/support/lcm_schema.h"
#include "tests/support/message_equal.h"

namespace visavis {
namespace {

template <typename... T>
struct TypeNames {
  std::set<std::string> names{T::getTypeName()...};
};

TEST(FingerprintTest, EqualsBotCores) {
  EXPECT_EQ(static_cast<std::uint64_t>(image_t::getHash()), 0x14739ffe13d5f5f0u);
  EXPECT_EQ(static_cast<std::uint64_t>(image_metadata_t::getHash()), 0x9a4b634d0577fb8eu);
  EXPECT_EQ(static_cast<std::uint64_t>(images_t::getHash()), 0x20ba4f05e8f5e33au);
  EXPECT_EQ(static_cast<std::uint64_t>(rigid_transform_t::getHash()), 0xea9ffbf2acc5c5aeu);
  EXPECT_EQ(static_cast<std::uint64_t>(joint_state_t::getHash()), 0x3e377b4cebc593a4u);
}

TEST(FingerprintTest, EqualsDrakes) {
  EXPECT_EQ(static_cast<std::uint64_t>(iiwa_status_t::getHash()), 0xf16fb804284abca3u);
  EXPECT_EQ(static_cast<std::uint64_t>(panda_status_t::getHash()), 0x19571cdf4d82fae6u);
}

TEST(FingerprintTest, PixelFormatsEqualBotCores) {
  EXPECT_EQ(image_t::PIXELFORMAT_GRAY, 1497715271);
  EXPECT_EQ(image_t::PIXELFORMAT_RGB, 859981650);
  EXPECT_EQ(image_t::PIXELFORMAT_BGR, 861030210);
  EXPECT_EQ(image_t::PIXELFORMAT_MJPEG, 1196444237);
  EXPECT_EQ(image_t::PIXELFORMAT_BAYER_BGGR, 825770306);
  EXPECT_EQ(image_t::PIXELFORMAT_BAYER_GBRG, 844650584);
  EXPECT_EQ(image_t::PIXELFORMAT_BAYER_GRBG, 861427800);
  EXPECT_EQ(image_t::PIXELFORMAT_BAYER_RGGB, 878205016);
  EXPECT_EQ(images_t::LEFT, 0);
  EXPECT_EQ(images_t::RIGHT, 1);
}

TEST(FingerprintTest, EveryLcmFileIsBuilt) {
  std::set<std::string> files;
  for (const auto& [name, message] : ReadProjectSchema()) files.insert(name);
  EXPECT_EQ(AllTypes<TypeNames>().names, files);
}

template <typename T>
class EveryTypeTest : public ::testing::Test {};
TYPED_TEST_SUITE(EveryTypeTest, AllTypes<::testing::Types>);

TYPED_TEST(EveryTypeTest, FingerprintFollowsFromTheFile) {
  EXPECT_EQ(TypeParam::getHash(), Fingerprint(ReadProjectSchema(), TypeParam::getTypeName()));
}

TYPED_TEST(EveryTypeTest, ShortestMessageIsAsLongAsTheFileSays) {
  EXPECT_EQ(TypeParam{}.getEncodedSize(),
            8 + MinEncodedSize(ReadProjectSchema(), TypeParam::getTypeName()));
}

TEST(FingerprintTest, IgnoresNamesOfTypesAndKeepsNamesOfFields) {
  LcmSchema schema = ReadProjectSchema();
  const std::int64_t before = Fingerprint(schema, "images_t");
  schema["picture_t"] = schema["image_t"];
  schema["images_t"].fields[3].type = "picture_t";
  EXPECT_EQ(Fingerprint(schema, "images_t"), before);
  schema["picture_t"].fields[0].name = "utime_us";
  EXPECT_NE(Fingerprint(schema, "images_t"), before);
}

// Message types are known by fingerprint alone: so a unit stands in a field's name.
TEST(FingerprintTest, TypesWithEqualFieldsDecodeIntoEachOther) {
  elsewhere::transform_t theirs{5, {1, 2, 3}, {1, 0, 0, 0}};
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(theirs.getEncodedSize()));
  const int size = static_cast<int>(bytes.size());
  ASSERT_EQ(theirs.encode(bytes.data(), 0, size), size);
  rigid_transform_t ours{};
  ASSERT_EQ(ours.decode(bytes.data(), 0, size), size);
  EXPECT_TRUE(MessageEqual(ours, {5, {1, 2, 3}, {1, 0, 0, 0}}));
  individual_t other{};
  EXPECT_EQ(other.decode(bytes.data(), 0, size), -1);
}

}  // namespace
}  // namespace visavis
