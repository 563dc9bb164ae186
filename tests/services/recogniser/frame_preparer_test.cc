#include "services/recogniser/frame_preparer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "services/recogniser/packed_map.h"
#include "tests/services/recogniser/published_settings.h"
#include "tests/support/malloc_counter.h"

namespace visavis {
namespace {

StereoImages ImagesOf(const StereoFrame& frame) { return {1234, frame.right, frame.left, 7}; }

// Mean of the absolute differences over the inner part of two RGB pictures.
double MeanDifference(const ImageView& a, const ImageView& b) {
  double sum = 0;
  int n = 0;
  for (int y = 20; y < a.height - 20; ++y) {
    for (int x = 3 * 20; x < 3 * (a.width - 20); ++x, ++n)
      sum += std::abs(a.row(y)[x] - b.row(y)[x]);
  }
  return sum / n;
}

StereoRig Distorted(const StereoRig& rig) {
  StereoRig distorted = rig;
  distorted.right.distortion = {-0.25, 0.1, 0.002, -0.001, 0.02};
  distorted.left.distortion = {-0.2, 0.05, -0.001, 0.003, 0};
  return distorted;
}

TEST(FramePreparerTest, WithoutDistortionTheCamerasPixelsAreHandedThrough) {
  StereoScene scene(TestHead(), SmallRig());
  const StereoFrame painted = scene.Paint(PhiOf(10, 0, 1000, 0, 0, 0));
  FramePreparer preparer(SmallRig());
  const StereoFrame frame = preparer.Prepare(ImagesOf(painted));
  EXPECT_EQ(frame.utime_us, 1234);
  EXPECT_EQ(frame.right->data, painted.right->data);
  EXPECT_EQ(frame.left->data, painted.left->data);
}

// The painter follows each pixel's ray through the distortion; undone, the picture must be the one
// that ideal cameras see.
TEST(FramePreparerTest, ADistortedPictureIsUndistortedToItsIdealTwin) {
  const StereoRig ideal = TestRig(), distorted = Distorted(ideal);
  StereoScene ideal_scene(TestHead(), ideal), distorted_scene(TestHead(), distorted);
  const RigidTransform X_CM = TransformFromPhi(PhiOf(130, 90, 800, 5, -8, 4));
  const StereoFrame twin = ideal_scene.Paint(X_CM), raw = distorted_scene.Paint(X_CM);
  FramePreparer preparer(distorted);
  const StereoFrame frame = preparer.Prepare(ImagesOf(raw));
  for (const bool is_left : {false, true}) {
    const ImageView& expected = is_left ? *twin.left : *twin.right;
    const ImageView& given = is_left ? *raw.left : *raw.right;
    const ImageView& got = is_left ? *frame.left : *frame.right;
    EXPECT_LT(MeanDifference(got, expected), 0.4) << is_left;
    EXPECT_GT(MeanDifference(given, expected), 3 * MeanDifference(got, expected)) << is_left;
  }
}

TEST(FramePreparerTest, OneDistortedCameraIsUndistortedAlone) {
  StereoRig rig = SmallRig();
  rig.left.distortion[0] = -0.2;
  StereoScene scene(TestHead(), rig);
  const StereoFrame painted = scene.Paint(PhiOf(10, 0, 1000, 0, 0, 0));
  FramePreparer preparer(rig);
  const StereoFrame frame = preparer.Prepare(ImagesOf(painted));
  EXPECT_EQ(frame.right->data, painted.right->data);
  EXPECT_NE(frame.left->data, painted.left->data);
}

// The corners of an undistorted pincushion picture lie outside the camera's. They must count as
// what lies outside the image: white, neither hair nor skin.
TEST(FramePreparerTest, WhatTheLensDoesNotShowIsWhite) {
  StereoRig rig = SmallRig();
  rig.right.distortion[0] = 0.6;
  const OwnedImage black = FlatImage(320, 240, 0, 0, 0);
  FramePreparer preparer(rig);
  const ImageView picture = *preparer.Prepare({0, black.view, std::nullopt, 0}).right;
  PackedMap map(320, 240);
  map.Build(picture, {});
  for (const int x : {0, 319}) {
    for (const int y : {0, 239}) EXPECT_EQ(map.at(x, y), 0u) << x << ' ' << y;
  }
  EXPECT_NE(map.at(160, 120), 0u);
}

TEST(FramePreparerTest, GrayPicturesAreUndistortedToo) {
  const StereoRig rig = Distorted(SmallRig());
  StereoScene scene(TestHead(), rig);
  const StereoFrame painted = scene.Paint(PhiOf(10, 0, 1000, 0, 0, 0));
  const OwnedImage right = GrayImage(*painted.right), left = GrayImage(*painted.left);
  FramePreparer preparer(rig);
  const StereoFrame frame = preparer.Prepare({0, right.view, left.view, 0});
  EXPECT_EQ(frame.right->format, PixelFormat::kGray);
  EXPECT_NE(frame.right->data, right.view.data);
}

TEST(FramePreparerTest, JpegIsDecodedToNearlyTheSamePicture) {
  StereoScene scene(TestHead(), SmallRig());
  const StereoFrame painted = scene.Paint(PhiOf(10, 0, 1000, 0, 0, 0));
  JpegEncoder right, left;
  FramePreparer preparer(SmallRig());
  const StereoFrame frame =
      preparer.Prepare({0, right.Encode(*painted.right, 95), left.Encode(*painted.left, 95), 0});
  EXPECT_EQ(BytesPerPixel(frame.right->format), 3);
  EXPECT_LT(MeanDifference(*frame.right, *painted.right), 2);
  EXPECT_LT(MeanDifference(*frame.left, *painted.left), 2);
}

TEST(FramePreparerTest, AJpegThroughADistortedLensIsDecodedThenUndistorted) {
  const StereoRig ideal = SmallRig(), distorted = Distorted(ideal);
  StereoScene ideal_scene(TestHead(), ideal), distorted_scene(TestHead(), distorted);
  const Vector6d phi = PhiOf(60, 30, 1000, 0, 0, 0);
  const StereoFrame twin = ideal_scene.Paint(phi);
  JpegEncoder right;
  FramePreparer preparer(distorted);
  const StereoFrame frame =
      preparer.Prepare({0, right.Encode(*distorted_scene.Paint(phi).right, 95), std::nullopt, 0});
  EXPECT_LT(MeanDifference(*frame.right, *twin.right), 3);
}

TEST(FramePreparerTest, AMissingPictureStaysMissing) {
  StereoScene scene(TestHead(), SmallRig());
  const StereoFrame painted = scene.Paint(PhiOf(10, 0, 1000, 0, 0, 0));
  FramePreparer preparer(SmallRig());
  EXPECT_FALSE(preparer.Prepare({0, painted.right, std::nullopt, 0}).left);
  EXPECT_FALSE(preparer.Prepare({0, std::nullopt, painted.left, 0}).right);
}

TEST(FramePreparerTest, ADamagedJpegIsRefused) {
  StereoScene scene(TestHead(), SmallRig());
  JpegEncoder encoder;
  const ImageView jpeg = encoder.Encode(*scene.Paint(PhiOf(10, 0, 1000, 0, 0, 0)).right, 90);
  FramePreparer preparer(SmallRig());
  std::vector<std::uint8_t> bytes(jpeg.data, jpeg.data + jpeg.size);
  const auto prepare = [&](std::size_t size) {
    ImageView view = jpeg;
    view.data = bytes.data();
    view.size = size;
    preparer.Prepare({0, view, std::nullopt, 0});
  };
  EXPECT_NO_THROW(prepare(bytes.size()));
  EXPECT_THAT([&] { prepare(bytes.size() / 2); }, ::testing::Throws<std::invalid_argument>());
  EXPECT_THAT([&] { prepare(10); }, ::testing::Throws<std::invalid_argument>());
  bytes[0] = 0;
  EXPECT_THAT([&] { prepare(bytes.size()); }, ::testing::Throws<std::invalid_argument>());
}

TEST(FramePreparerTest, AllocatesNothingAfterTheFirstFrame) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  StereoScene scene(TestHead(), SmallRig());
  const StereoFrame painted = scene.Paint(PhiOf(10, 0, 1000, 0, 0, 0));
  FramePreparer preparer(SmallRig());
  preparer.Prepare(ImagesOf(painted));
  const std::int64_t before = NumMallocs();
  preparer.Prepare(ImagesOf(painted));
  EXPECT_EQ(NumMallocs(), before);
}

}  // namespace
}  // namespace visavis
