#include "services/recogniser/refined/working_pair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/core/random.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

Vector3d RandomInBall(Random* random, double radius) {
  Vector3d p;
  do {
    for (int k = 0; k < 3; ++k) p[k] = random->Uniform(-radius, radius);
  } while (p.norm() > radius);
  return p;
}

/// The pixel of p_M through the estimator's own geometry.
Eigen::Vector2d Pixel(const EyeGeometry& eye, const RigidTransform& X_CM, const Vector3d& p_M) {
  const EyePose pose(eye, X_CM);
  const Eigen::Vector3f p = pose.InEye(p_M.cast<float>());
  return Eigen::Vector2f(eye.cx + eye.fx * p.x() / p.z(), eye.cy + eye.fy * p.y() / p.z())
      .cast<double>();
}

StereoRig FourTimes(StereoRig rig) {
  for (Pinhole* camera : {&rig.right, &rig.left}) {
    camera->width *= 4;
    camera->height *= 4;
    camera->fx *= 4;
    camera->fy *= 4;
    camera->cx = 4 * (camera->cx + 0.5) - 0.5;
    camera->cy = 4 * (camera->cy + 0.5) - 0.5;
  }
  return rig;
}

TEST(EyeTest, ProjectionEqualsTheRigs) {
  for (const StereoRig& rig : {TestRig(), UnevenRig()}) {
    const EyeGeometry right(rig.right, RigidTransform::Identity()), left(rig.left, rig.X_CL);
    Random random(1);
    for (int i = 0; i < 100; ++i) {
      const RigidTransform X_CM = TransformFromPhi(RandomPhi(&random));
      const Vector3d p_M = RandomInBall(&random, 0.12);
      EXPECT_LT((Pixel(right, X_CM, p_M) - ProjectRight(rig, X_CM, p_M).uv).norm(), 1e-3);
      EXPECT_LT((Pixel(left, X_CM, p_M) - ProjectLeft(rig, X_CM, p_M).uv).norm(), 1e-3);
    }
  }
}

TEST(EyeTest, TheEyeSeenFromTheHeadIsTheCamerasOrigin) {
  const StereoRig rig = UnevenRig();
  const EyeGeometry left(rig.left, rig.X_CL);
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform X_CM = TransformFromPhi(RandomPhi(&random));
    const EyePose pose(left, X_CM);
    const Vector3d p_ML = X_CM.inverse() * rig.X_CL.translation();
    EXPECT_LT((pose.p_ME.cast<double>() - p_ML).norm(), 1e-6);
    EXPECT_LT(pose.InEye(pose.p_ME).norm(), 1e-6f);
  }
}

TEST(EyeTest, APointWhoseNormalLooksAtTheEyeIsTurnedToIt) {
  const StereoRig rig = TestRig();
  const EyePose pose(EyeGeometry(rig.right, RigidTransform::Identity()),
                     TransformFromPhi(PhiOf(0, 0, 1000, 0, 0, 0)));
  const Eigen::Vector3f front(0, 0, -0.1f), back(0, 0, 0.1f);
  EXPECT_LT(Eigen::Vector3f(0, 0, -1).dot(front - pose.p_ME), 0);
  EXPECT_GT(Eigen::Vector3f(0, 0, 1).dot(back - pose.p_ME), 0);
}

TEST(PixelBoxTest, WidthHeightAndEmptinessFollowFromItsBorders) {
  const PixelBox box{16, 32, 48, 40};
  EXPECT_EQ(box.width(), 32);
  EXPECT_EQ(box.height(), 8);
  EXPECT_FALSE(box.empty());
  EXPECT_TRUE(PixelBox{}.empty());
  EXPECT_TRUE((PixelBox{16, 0, 16, 8}).empty());
}

TEST(WorkingPairTest, PicturesAreHalvedUntilAPixelIsAboutOneAndAQuarterMillimetres) {
  EXPECT_EQ(WorkingPair(TestRig(), 1.0).halvings(), 0);
  EXPECT_EQ(WorkingPair(FourTimes(TestRig()), 1.0).halvings(), 2);
  EXPECT_EQ(WorkingPair(FourTimes(SmallRig()), 1.0).halvings(), 1);
  EXPECT_EQ(WorkingPair(SmallRig(), 1.0).halvings(), 0);
  EXPECT_EQ(WorkingPair(SmallRig(), 0.25).halvings(), 1);
}

// Four pixels centred at 2 i, 2 i + 1 become one centred at i: u' + 1/2 = (u + 1/2) / 2.
TEST(WorkingPairTest, PicturesThatAreTooSmallAtThatResolutionAreRefusedByCameraAndField) {
  const auto expect_refusal = [](const StereoRig& rig, const std::string& what) {
    EXPECT_THAT([&] { WorkingPair(rig, 1); },
                ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr(what)));
  };
  StereoRig rig = TestRig();
  rig.right.width = 15;
  expect_refusal(rig, "rig: right.width: 15: must be 16 px or more for estimator refined");
  rig.right.width = 16;
  EXPECT_NO_THROW(WorkingPair(rig, 1));
  rig.left.height = 8;
  expect_refusal(rig, "rig: left.height: 8: must be 16 px or more");
  rig = TestRig();
  rig.right.fx = 100'000;  // seven halvings
  expect_refusal(rig, "rig: right.width: 640: must be 2048 px or more where fx is 100000 px");
}

TEST(WorkingPairTest, ProjectionIntoHalvedPicturesKeepsThePixelsCentres) {
  const StereoRig rig = FourTimes(UnevenRig());
  const WorkingPair pair(rig, 0.6);
  ASSERT_EQ(pair.halvings(), 2);
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform X_CM = TransformFromPhi(RandomPhi(&random));
    const Vector3d p_M = RandomInBall(&random, 0.12);
    const Eigen::Vector2d half(0.5, 0.5);
    const Eigen::Vector2d right = (ProjectRight(rig, X_CM, p_M).uv + half) / 4 - half;
    const Eigen::Vector2d left = (ProjectLeft(rig, X_CM, p_M).uv + half) / 4 - half;
    EXPECT_LT((Pixel(pair.eye(0), X_CM, p_M) - right).norm(), 1e-3);
    EXPECT_LT((Pixel(pair.eye(1), X_CM, p_M) - left).norm(), 1e-3);
  }
}

TEST(WorkingPairTest, AHalvedPixelIsTheRoundedMeanOfFour) {
  StereoRig rig = SmallRig();
  for (Pinhole* camera : {&rig.right, &rig.left}) {
    camera->width = 38;  // 38 halves to 19: odd sizes too
    camera->height = 38;
  }
  WorkingPair pair(rig, 0.25);
  ASSERT_EQ(pair.halvings(), 1);
  Random random(4);
  const OwnedImage rgb = NoiseImage(38, 38, &random), gray = GrayImage(rgb.view);
  for (const OwnedImage* image : {&rgb, &gray}) {
    const int channels = BytesPerPixel(image->view.format);
    const std::optional<ImageView> half = pair.Picture({0, image->view, std::nullopt}, 0);
    ASSERT_TRUE(half);
    ASSERT_EQ(half->width, 19);
    ASSERT_EQ(half->height, 19);
    EXPECT_EQ(half->format, image->view.format);
    EXPECT_EQ(half->stride, 19 * channels);
    EXPECT_EQ(half->size, static_cast<std::size_t>(19 * 19 * channels));
    for (int y = 0; y < 19; ++y) {
      for (int i = 0; i < 19 * channels; ++i) {
        const int x = i / channels * 2 * channels + i % channels;
        const std::uint8_t *a = image->view.row(2 * y), *b = image->view.row(2 * y + 1);
        const int sum = a[x] + a[x + channels] + b[x] + b[x + channels];
        EXPECT_EQ(half->row(y)[i], (sum + 2) / 4);
      }
    }
  }
}

TEST(WorkingPairTest, TwiceHalvedIsTheMeanOfSixteen) {
  StereoRig rig = TestRig();
  rig.right.width = rig.left.width = 64;
  rig.right.height = rig.left.height = 64;
  WorkingPair pair(rig, 0.25);
  ASSERT_EQ(pair.halvings(), 2);
  Random random(5);
  const OwnedImage image = NoiseImage(64, 64, &random);
  const std::optional<ImageView> small = pair.Picture({0, std::nullopt, image.view}, 1);
  ASSERT_TRUE(small);
  ASSERT_EQ(small->width, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      double sum = 0;
      for (int k = 0; k < 16; ++k) sum += image.view.row(4 * y + k / 4)[3 * (4 * x + k % 4) + 1];
      EXPECT_NEAR(small->row(y)[3 * x + 1], sum / 16, 1.01);
    }
  }
}

TEST(WorkingPairTest, BothEyesKeepTheirOwnHalvedPictures) {
  StereoRig rig = TestRig();
  rig.right.width = rig.left.width = 64;
  rig.right.height = rig.left.height = 64;
  WorkingPair pair(rig, 0.25);
  const OwnedImage dark = FlatImage(64, 64, 10, 10, 10), bright = FlatImage(64, 64, 200, 200, 200);
  const StereoFrame frame{0, dark.view, bright.view};
  const std::optional<ImageView> right = pair.Picture(frame, 0), left = pair.Picture(frame, 1);
  EXPECT_EQ(right->row(3)[5], 10);
  EXPECT_EQ(left->row(3)[5], 200);
}

TEST(WorkingPairTest, WithoutHalvingsThePictureIsTheCamerasOwnAndAMissingOneStaysMissing) {
  WorkingPair pair(SmallRig(), 1.0);
  const OwnedImage image = FlatImage(320, 240, 1, 2, 3);
  const StereoFrame frame{0, image.view, std::nullopt};
  EXPECT_EQ(pair.Picture(frame, 0)->data, image.view.data);
  EXPECT_FALSE(pair.Picture(frame, 1));
}

SearchSpace FarSpace() {
  SearchSpace space;
  space.min << -0.2, -0.2, 1.6, -0.3, -0.3, -0.3;
  space.max << 0.2, 0.2, 3.2, 0.3, 0.3, 0.3;
  return space;
}

TEST(WorkingPairTest, OnlyWhereAPixelIsLargeOnTheHeadAreWindowsDoubled) {
  EXPECT_TRUE(WorkingPair(TestRig(), FarSpace()).is_doubled());
  SearchSpace near = FarSpace();
  near.min[2] = 0.9;
  near.max[2] = 1.2;
  EXPECT_FALSE(WorkingPair(TestRig(), near).is_doubled());
  EXPECT_FALSE(WorkingPair(FourTimes(TestRig()), FarSpace()).is_doubled());
  EXPECT_FALSE(WorkingPair(TestRig(), 2.4).is_doubled());
}

// Pixels of the cameras' pictures, doubled, but for an even offset that is the same for all.
TEST(WorkingPairTest, DoubledWindowsShowAHeadAnywhereInTheirSpace) {
  const StereoRig rig = UnevenRig();
  WorkingPair pair(rig, FarSpace());
  ASSERT_TRUE(pair.is_doubled());
  const Eigen::Vector2d half(0.5, 0.5);
  Random random(8);
  std::optional<Eigen::Vector2d> corner;
  for (int i = 0; i < 100; ++i) {
    Vector6d phi;
    for (int k = 0; k < 6; ++k) phi[k] = random.Uniform(FarSpace().min[k], FarSpace().max[k]);
    const RigidTransform X_CM = TransformFromPhi(phi);
    const Vector3d p_M = RandomInBall(&random, 0.12);
    const Eigen::Vector2d pixel = Pixel(pair.eye(1), X_CM, p_M);
    const Eigen::Vector2d uv = ProjectLeft(rig, X_CM, p_M).uv;
    EXPECT_TRUE(pixel.x() > 0 && pixel.y() > 0 && pixel.x() < pair.eye(1).width &&
                pixel.y() < pair.eye(1).height)
        << pixel.transpose();
    const Eigen::Vector2d offset = (2 * (uv + half) - half - pixel) / 2;
    if (!corner) corner = offset;
    EXPECT_LT((offset - *corner).norm(), 1e-2);
    EXPECT_LT((offset - offset.array().round().matrix()).norm(), 1e-2);
  }
}

TEST(WorkingPairTest, AWindowFollowsWhatItIsToldToLookAtAndStaysInThePicture) {
  WorkingPair pair(TestRig(), FarSpace());
  const auto pixel = [&](std::size_t eye, double x_mm) {
    return Pixel(pair.eye(eye), TransformFromPhi(PhiOf(x_mm, 0, 2000, 0, 0, 0)), Vector3d::Zero());
  };
  for (const double x_mm : {0.0, 100.0, -150.0}) {
    pair.LookAt(Vector3d(1e-3 * x_mm, 0, 2));
    EXPECT_NEAR(pixel(0, x_mm).x(), 0.5 * pair.eye(0).width, 3);
    EXPECT_NEAR(pixel(1, x_mm).x(), 0.5 * pair.eye(1).width, 3);
  }
  const OwnedImage image = FlatImage(640, 480, 7, 8, 9);
  for (const Vector3d& p_C : {Vector3d(5, 0, 2), Vector3d(-5, 9, 2), Vector3d(0, 0, -1),
                              Vector3d(NAN, NAN, NAN), Vector3d(0, 0, 0)}) {
    pair.LookAt(p_C);
    const auto picture = pair.Picture({0, image.view, image.view}, 0);
    pair.Fill(0, pair.WholeBox(0));
    EXPECT_EQ(picture->row(pair.WholeBox(0).y1 - 1)[3 * (pair.WholeBox(0).x1 - 1) + 2], 9);
  }
}

TEST(WorkingPairTest, ADoubledPixelIsInterpolated) {
  StereoRig rig = TestRig();
  rig.right.width = rig.left.width = 60;
  rig.right.height = rig.left.height = 40;
  WorkingPair pair(rig, FarSpace());
  ASSERT_TRUE(pair.is_doubled());
  ASSERT_EQ(pair.eye(0).width, 112);  // a multiple of 16
  ASSERT_EQ(pair.eye(0).height, 80);
  const double first_u = rig.left.cx + 0.5 - (pair.eye(1).cx + 0.5) / 2;
  const double first_v = rig.left.cy + 0.5 - (pair.eye(1).cy + 0.5) / 2;
  Random random(9);
  const OwnedImage rgb = NoiseImage(60, 40, &random), gray = GrayImage(rgb.view);
  for (const OwnedImage* image : {&rgb, &gray}) {
    const ImageView& from = image->view;
    const int channels = BytesPerPixel(from.format);
    const auto doubled = pair.Picture({0, std::nullopt, from}, 1);
    ASSERT_TRUE(doubled);
    EXPECT_EQ(doubled->format, from.format);
    for (const PixelBox& box : {PixelBox{16, 32, 48, 64}, PixelBox{0, 0, 112, 80}}) {
      pair.Fill(1, box);
      for (int y = box.y0; y < box.y1; ++y) {
        for (int i = box.x0 * channels; i < box.x1 * channels; ++i) {
          const double u = first_u + (i / channels + 0.5) / 2 - 0.5;
          const double v = first_v + (y + 0.5) / 2 - 0.5;
          const auto at = [&](double column, double row) {
            const int x = std::clamp(static_cast<int>(column), 0, from.width - 1);
            return double(from.row(std::clamp(static_cast<int>(row), 0,
                                              from.height - 1))[x * channels + i % channels]);
          };
          const double u0 = std::floor(u), v0 = std::floor(v), a = u - u0, b = v - v0;
          const double expected = (1 - b) * ((1 - a) * at(u0, v0) + a * at(u0 + 1, v0)) +
                                  b * ((1 - a) * at(u0, v0 + 1) + a * at(u0 + 1, v0 + 1));
          ASSERT_NEAR(doubled->row(y)[i], expected, 0.51) << i << " " << y;
        }
      }
    }
  }
}

TEST(WorkingPairTest, BoxesContainASphereAndStayInThePicture) {
  for (const StereoRig& rig : {SmallRig(), TestRig(), UnevenRig()}) {
    const WorkingPair pair(rig, 1.0);
    Random random(6);
    for (int i = 0; i < 60; ++i) {
      const RigidTransform X_CM = TransformFromPhi(RandomPhi(&random));
      for (std::size_t e = 0; e < 2; ++e) {
        const EyeGeometry& eye = pair.eye(e);
        const PixelBox box = pair.BoxAround(e, X_CM, 0.15), whole = pair.WholeBox(e);
        EXPECT_GE(box.x0, 0);
        EXPECT_GE(box.y0, 0);
        EXPECT_LE(box.x1, eye.width);
        EXPECT_LE(box.y1, eye.height);
        EXPECT_EQ(box.x0 % 16 + box.y0 % 16 + box.x1 % 16 + box.y1 % 16, 0);
        for (int k = 0; k < 100; ++k) {
          const Vector3d p_M = 0.15 * RandomInBall(&random, 1).normalized();
          const Eigen::Vector2d uv = Pixel(eye, X_CM, p_M);
          if (uv.x() < 0 || uv.y() < 0 || uv.x() > whole.x1 - 1 || uv.y() > whole.y1 - 1) continue;
          EXPECT_TRUE(uv.x() >= box.x0 && uv.x() <= box.x1 && uv.y() >= box.y0 && uv.y() <= box.y1)
              << uv.transpose();
        }
      }
    }
  }
}

TEST(WorkingPairTest, ABoxIsNoLargerThanTheSphereNeeds) {
  const WorkingPair pair(TestRig(), 1.0);
  const PixelBox box = pair.BoxAround(0, TransformFromPhi(PhiOf(0, 0, 1000, 0, 0, 0)), 0.1);
  const double diameter = 2 * 800 * 0.1 / std::sqrt(1 - 0.1 * 0.1);
  EXPECT_LT(box.width(), diameter + 2 * 16);
  EXPECT_GT(box.width(), diameter);
}

TEST(WorkingPairTest, TheBoxOfAHeadOutOfSightIsEmptyOfOneAtTheLensTheWholePicture) {
  const WorkingPair pair(SmallRig(), 1.0);
  EXPECT_TRUE(pair.BoxAround(0, TransformFromPhi(PhiOf(3000, 0, 1000, 0, 0, 0)), 0.15).empty());
  EXPECT_TRUE(pair.BoxAround(0, TransformFromPhi(PhiOf(0, -3000, 1000, 0, 0, 0)), 0.15).empty());
  const PixelBox whole = pair.WholeBox(0);
  const PixelBox near = pair.BoxAround(0, TransformFromPhi(PhiOf(0, 0, 200, 0, 0, 0)), 0.15);
  EXPECT_EQ(near.width(), whole.width());
  EXPECT_EQ(near.height(), whole.height());
  EXPECT_EQ(whole.width(), 320);
  EXPECT_EQ(whole.height(), 240);
}

}  // namespace
}  // namespace visavis
