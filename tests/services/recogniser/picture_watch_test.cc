#include "services/recogniser/picture_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/core/random.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

class PictureWatchTest : public ::testing::Test {
 protected:
  OwnedImage NewPicture() { return NoiseImage(64, 48, &random_); }
  StereoImages Show(const OwnedImage& right, const OwnedImage& left) {
    StereoImages images{0, right.view, left.view, std::nullopt};
    watch_.TakeOutStale(&images);
    return images;
  }
  Random random_{5};
  PictureWatch watch_;
};

TEST_F(PictureWatchTest, ALivePairIsLeftAsItIs) {
  for (int i = 0; i < 5; ++i) {
    const OwnedImage right = NewPicture(), left = NewPicture();
    const StereoImages images = Show(right, left);
    EXPECT_TRUE(images.right && images.left);
    EXPECT_EQ(watch_.complaint(), "");
  }
  EXPECT_EQ(watch_.num_stale_right() + watch_.num_stale_left(), 0);
}

TEST_F(PictureWatchTest, ARepeatedPictureIsTakenOutWhereTheOtherChanges) {
  const OwnedImage stuck = NewPicture(), first = NewPicture(), second = NewPicture();
  Show(first, stuck);
  StereoImages images = Show(second, stuck);
  EXPECT_TRUE(images.right);
  EXPECT_FALSE(images.left);
  EXPECT_EQ(watch_.num_stale_left(), 1);
  EXPECT_THAT(watch_.complaint(), HasSubstr("left camera are stale"));
  images = Show(second, first);  // now the right one
  EXPECT_FALSE(images.right);
  EXPECT_TRUE(images.left);
  EXPECT_EQ(watch_.num_stale_right(), 1);
  EXPECT_THAT(watch_.complaint(), HasSubstr("right camera are stale"));
  const OwnedImage third = NewPicture(), fourth = NewPicture();
  images = Show(third, fourth);
  EXPECT_TRUE(images.right && images.left);
  EXPECT_EQ(watch_.complaint(), "");
}

TEST_F(PictureWatchTest, ForgettingTakesTheComplaintBackAndKeepsTheCount) {
  const OwnedImage stuck = NewPicture(), first = NewPicture(), second = NewPicture();
  Show(first, stuck);
  Show(second, stuck);
  ASSERT_NE(watch_.complaint(), "");
  watch_.Forget();
  EXPECT_EQ(watch_.complaint(), "");
  EXPECT_EQ(watch_.num_stale_left(), 1);
}

TEST_F(PictureWatchTest, AStillPictureOfBothIsNoFault) {
  const OwnedImage right = NewPicture(), left = NewPicture();
  for (int i = 0; i < 5; ++i) {
    const StereoImages images = Show(right, left);
    EXPECT_TRUE(images.right && images.left);
  }
  EXPECT_EQ(watch_.num_stale_right() + watch_.num_stale_left(), 0);
}

TEST_F(PictureWatchTest, APairOfOneAndWhatWasForgottenProveNothing) {
  const OwnedImage a = NewPicture(), b = NewPicture(), c = NewPicture();
  Show(a, b);
  StereoImages alone{0, c.view, std::nullopt, std::nullopt};
  watch_.TakeOutStale(&alone);
  EXPECT_TRUE(alone.right);
  EXPECT_TRUE(Show(c, b).left);
  watch_.Forget();
  EXPECT_TRUE(Show(a, b).left);
  EXPECT_EQ(watch_.num_stale_left(), 0);
}

TEST_F(PictureWatchTest, TheChecksumSeesOneBitOfEveryRowOfASmallPictureAndNotThePadding) {
  OwnedImage picture = NewPicture();
  const std::uint64_t sum = PictureChecksum(picture.view);
  for (int y = 0; y < 48; ++y) {
    std::uint8_t& byte = picture.bytes[static_cast<std::size_t>(y * 3 * 64 + 7 * y % 192)];
    byte ^= 1;
    EXPECT_NE(PictureChecksum(picture.view), sum) << y;
    byte ^= 1;
  }
  ImageView narrow = picture.view;
  narrow.width = 63;
  const std::uint64_t narrow_sum = PictureChecksum(narrow);
  picture.bytes[3 * 63] ^= 1;
  EXPECT_EQ(PictureChecksum(narrow), narrow_sum);
  ImageView jpeg = picture.view;
  jpeg.format = PixelFormat::kJpeg;
  jpeg.size = 1001;
  const std::uint64_t jpeg_sum = PictureChecksum(jpeg);
  picture.bytes[1000] ^= 1;
  EXPECT_NE(PictureChecksum(jpeg), jpeg_sum);
}

}  // namespace
}  // namespace visavis
