// Pictures of every format and size through the whole recogniser, to a pose that is right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "common/convert/pose_message.h"
#include "common/image/image_decoder.h"
#include "services/recogniser/published_estimator.h"
#include "services/recogniser/refined/head_geometry.h"
#include "tests/services/recogniser/service_bench.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

/// Every second pixel of a colour filter, in the order that the format's name has.
OwnedImage BayerImage(const ImageView& rgb, PixelFormat format) {
  const std::string order = PixelFormatName(format).substr(6);  // of bayer_rggb
  OwnedImage image;
  for (int y = 0; y < rgb.height; ++y) {
    for (int x = 0; x < rgb.width; ++x) {
      const char color = order[static_cast<std::size_t>(2 * (y % 2) + x % 2)];
      image.bytes.push_back(rgb.row(y)[3 * x + (color == 'r' ? 0 : color == 'g' ? 1 : 2)]);
    }
  }
  image.view = {image.bytes.data(), rgb.width, rgb.height, rgb.width, image.bytes.size(), format};
  return image;
}

/// A copy whose rows are padded by odd numbers of bytes.
OwnedImage PaddedImage(const ImageView& from) {
  OwnedImage image;
  const int row_bytes = from.width * BytesPerPixel(from.format), stride = row_bytes + 37;
  image.bytes.assign(static_cast<std::size_t>(stride) * static_cast<std::size_t>(from.height), 255);
  for (int y = 0; y < from.height; ++y) {
    std::copy(from.row(y), from.row(y) + row_bytes,
              image.bytes.begin() + y * std::ptrdiff_t{stride});
  }
  image.view = from;
  image.view.data = image.bytes.data();
  image.view.stride = stride;
  image.view.size = image.bytes.size();
  return image;
}

OwnedImage InFormat(const ImageView& rgb, PixelFormat format) {
  switch (format) {
    case PixelFormat::kGray:
      return GrayImage(rgb);
    case PixelFormat::kRgb:
      return PaddedImage(rgb);
    case PixelFormat::kBgr:
      return BgrImage(rgb);
    case PixelFormat::kJpeg: {
      JpegEncoder encoder;
      OwnedImage image;
      image.view = encoder.Encode(rgb, 90);
      image.bytes.assign(image.view.data, image.view.data + image.view.size);
      image.view.data = image.bytes.data();
      return image;
    }
    default:
      return BayerImage(rgb, format);
  }
}

/// Cameras of this size side by side, 60 mm a head's breadth of sight at 1 m as TestRig.
StereoRig RigOf(int width, int height) {
  const double f = 800.0 * width / 640;
  const Pinhole camera{width, height, f, f, 0.5 * (width - 1) + 3, 0.5 * (height - 1) - 2, {}};
  StereoRig rig{camera, camera, RigidTransform::Identity()};
  rig.X_CL.translation().x() = -0.15;
  return rig;
}

struct FormatCase {
  PixelFormat format;
  int width, height;
  friend void PrintTo(const FormatCase& c, std::ostream* os) {
    *os << PixelFormatName(c.format) << ' ' << c.width << 'x' << c.height;
  }
};

class ServiceFormatsTest : public ::testing::TestWithParam<FormatCase> {
 protected:
  /// The last of @p frames poses of a head at rest.
  head_pose_t PoseBy(const RecogniserConfig& config, int frames) {
    const FormatCase& c = GetParam();
    const StereoRig rig = RigOf(c.width, c.height);
    MeshScene scene(rig);
    scene.Show(X_CM_, FeaturedHead);
    const OwnedImage right = InFormat(scene.picture(0), c.format);
    const OwnedImage left = InFormat(scene.picture(1), c.format);
    ServiceBench bench(config);
    bench.SendRig({rig, std::nullopt, std::nullopt});
    for (int i = 0; i < frames; ++i) {
      const std::int64_t t_us = 33'333 * (i + 1);
      bench.Send("STEREO_IMAGES", PairOf({0, right.view, left.view}, t_us), t_us);
    }
    EXPECT_EQ(bench.Status().rejected, 0) << bench.Status().last_error;
    const auto poses = bench.Poses();
    EXPECT_EQ(poses.size(), static_cast<std::size_t>(frames));
    return poses.back();
  }
  /// @p p_MR_m: where the pose is told from.
  double ErrorMm(const head_pose_t& pose, const Eigen::Vector3d& p_MR_m) const {
    const Eigen::Vector3d p_CR(pose.p_CM_m[0], pose.p_CM_m[1], pose.p_CM_m[2]);
    return 1e3 * (p_CR - X_CM_ * p_MR_m).norm();
  }
  const RigidTransform X_CM_{TransformFromPhi(PhiOf(30, -10, 1000, 3, -6, 4))};
};

TEST_P(ServiceFormatsTest, TheRefinedEstimatorTracksTheHead) {
  RecogniserConfig config;
  config.ego_motion = "none";
  const head_pose_t pose = PoseBy(config, 3);
  EXPECT_EQ(pose.status, head_pose_t::STATUS_TRACKING);
  EXPECT_LT(ErrorMm(pose, AdultOrigin()), 5);
}

TEST_P(ServiceFormatsTest, ThePublishedEstimatorKeepsAGivenHead) {
  RecogniserConfig config = EasyConfig();
  config.ego_motion = "none";
  config.start.phi_mm_deg = {30, -10, 1000, 3, -6, 4};
  const head_pose_t pose = PoseBy(config, 2);
  EXPECT_EQ(pose.status, head_pose_t::STATUS_TRACKING);
  EXPECT_LT(ErrorMm(pose, Eigen::Vector3d::Zero()), 40);
  EXPECT_GT(pose.fitness, 0.1);
}

std::string NameOf(const ::testing::TestParamInfo<FormatCase>& tested) {
  const FormatCase& c = tested.param;
  return PixelFormatName(c.format) + "_" + std::to_string(c.width) + "x" + std::to_string(c.height);
}

INSTANTIATE_TEST_SUITE_P(Formats, ServiceFormatsTest,
                         ::testing::Values(FormatCase{PixelFormat::kGray, 640, 480},
                                           FormatCase{PixelFormat::kRgb, 640, 480},
                                           FormatCase{PixelFormat::kBgr, 640, 480},
                                           FormatCase{PixelFormat::kBayerBggr, 640, 480},
                                           FormatCase{PixelFormat::kBayerGbrg, 640, 480},
                                           FormatCase{PixelFormat::kBayerGrbg, 640, 480},
                                           FormatCase{PixelFormat::kBayerRggb, 640, 480},
                                           FormatCase{PixelFormat::kJpeg, 640, 480}),
                         &NameOf);

INSTANTIATE_TEST_SUITE_P(Sizes, ServiceFormatsTest,
                         ::testing::Values(FormatCase{PixelFormat::kRgb, 641, 479},
                                           FormatCase{PixelFormat::kBayerRggb, 639, 481},
                                           FormatCase{PixelFormat::kJpeg, 643, 485},
                                           FormatCase{PixelFormat::kGray, 751, 577},
                                           FormatCase{PixelFormat::kRgb, 1281, 963},
                                           FormatCase{PixelFormat::kBayerGbrg, 1937, 1217},
                                           FormatCase{PixelFormat::kBayerRggb, 2592, 1944},
                                           FormatCase{PixelFormat::kGray, 2591, 1943}),
                         &NameOf);

}  // namespace
}  // namespace visavis
