#include "tests/support/stereo_scene.h"

#include <cmath>

#include "tests/support/naive_fitness.h"

namespace visavis {
namespace {

OwnedImage MakeImage(int width, int height, PixelFormat format) {
  const int bytes = BytesPerPixel(format);
  OwnedImage image;
  image.bytes.resize(static_cast<std::size_t>(width * height * bytes));
  image.view = {image.bytes.data(), width, height, width * bytes, image.bytes.size(), format};
  return image;
}

}  // namespace

Vector6d PhiOf(double x_mm, double y_mm, double z_mm, double phi_deg, double theta_deg,
               double psi_deg) {
  Vector6d phi;
  phi << x_mm / 1000, y_mm / 1000, z_mm / 1000, phi_deg * M_PI / 180, theta_deg * M_PI / 180,
      psi_deg * M_PI / 180;
  return phi;
}

Vector6d RandomPhi(Random* random) {
  Vector6d phi;
  phi << random->Uniform(-0.1, 0.1), random->Uniform(-0.1, 0.1), random->Uniform(0.95, 1.15),
      random->Uniform(-0.3, 0.3), random->Uniform(-0.3, 0.3), random->Uniform(-0.3, 0.3);
  return phi;
}

HeadModelConfig TestHead() {
  HeadModelConfig head;
  head.shape = "ellipsoid";
  head.semi_axis_x_mm = 80;
  head.semi_axis_y_mm = 108;
  head.semi_axis_z_mm = 98;
  head.hair_tilt_deg = 34;
  head.hair_offset_mm = -37;
  head.chin_gap_deg = 90;
  head.outline_width = 0.15;
  head.eye_x_mm = 31;
  head.eye_y_mm = 20;
  head.eye_half_width_mm = 14;
  head.eye_half_height_mm = 5;
  head.brow_y_mm = 10;
  head.brow_inner_x_mm = 13;
  head.brow_outer_x_mm = 52;
  head.brow_half_height_mm = 2.5;
  head.brow_arch_mm = 4;
  return head;
}

StereoRig SmallRig() {
  const Pinhole camera{320, 240, 400, 400, 159.5, 119.5, {}};
  StereoRig rig{camera, camera, RigidTransform::Identity()};
  rig.X_CL.translation().x() = -0.15;
  return rig;
}

StereoRig UnevenRig() {
  StereoRig rig;
  rig.right = {401, 303, 510, 498, 190.3, 160.8, {}};
  rig.left = {320, 240, 390, 402, 171.2, 110.4, {}};
  rig.X_CL =
      MakeTransform(RotationFromAngles({0.05, 0.14, -0.04}), Eigen::Vector3d(-0.16, 0.02, -0.03));
  return rig;
}

OwnedImage NoiseImage(int width, int height, Random* random) {
  OwnedImage image = MakeImage(width, height, PixelFormat::kRgb);
  for (std::uint8_t& byte : image.bytes) byte = static_cast<std::uint8_t>(random->Index(256));
  return image;
}

OwnedImage FlatImage(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  OwnedImage image = MakeImage(width, height, PixelFormat::kRgb);
  for (std::size_t i = 0; i < image.bytes.size(); i += 3) {
    image.bytes[i] = r;
    image.bytes[i + 1] = g;
    image.bytes[i + 2] = b;
  }
  return image;
}

OwnedImage GrayImage(const ImageView& rgb) {
  OwnedImage image = MakeImage(rgb.width, rgb.height, PixelFormat::kGray);
  auto out = image.bytes.begin();
  for (int y = 0; y < rgb.height; ++y) {
    for (const std::uint8_t* p = rgb.row(y); p < rgb.row(y) + 3 * rgb.width; p += 3) {
      *out++ = static_cast<std::uint8_t>(255 - NaiveBrightness(p[0], p[1], p[2]));
    }
  }
  return image;
}

OwnedImage BgrImage(const ImageView& rgb) {
  OwnedImage image = MakeImage(rgb.width, rgb.height, PixelFormat::kBgr);
  auto out = image.bytes.begin();
  for (int y = 0; y < rgb.height; ++y) {
    for (const std::uint8_t* p = rgb.row(y); p < rgb.row(y) + 3 * rgb.width; p += 3) {
      for (int k = 2; k >= 0; --k) *out++ = p[k];
    }
  }
  return image;
}

}  // namespace visavis
