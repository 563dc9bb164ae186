#include "services/recogniser/refined/working_pair.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace visavis {
namespace {

constexpr double kPixelsPerM = 800;
constexpr int kBoxGrid = 16;
constexpr int kLeastPicture_px = 16;

int HalvingsFor(const Pinhole& camera, double distance_m) {
  const double ratio = camera.fx / (distance_m * kPixelsPerM);
  return std::max(0, static_cast<int>(std::lround(std::log2(ratio))));
}

Pinhole Halved(Pinhole camera, int times) {
  camera.distortion = {};
  for (int i = 0; i < times; ++i) {
    camera.width /= 2;
    camera.height /= 2;
    camera.fx /= 2;
    camera.fy /= 2;
    camera.cx = 0.5 * (camera.cx + 0.5) - 0.5;
    camera.cy = 0.5 * (camera.cy + 0.5) - 0.5;
  }
  return camera;
}

/// @p from at half its size, each pixel the mean of four.
ImageView Halve(const ImageView& from, std::vector<std::uint8_t>* memory) {
  const int channels = BytesPerPixel(from.format);
  ImageView to = from;
  to.width = from.width / 2;
  to.height = from.height / 2;
  to.stride = to.width * channels;
  to.size = static_cast<std::size_t>(to.stride) * static_cast<std::size_t>(to.height);
  if (memory->size() < to.size) memory->resize(to.size);
  to.data = memory->data();
  for (int y = 0; y < to.height; ++y) {
    const std::uint8_t *a = from.row(2 * y), *b = from.row(2 * y + 1);
    std::uint8_t* out = memory->data() + static_cast<std::ptrdiff_t>(y) * to.stride;
    for (int x = 0; x < to.width; ++x) {
      for (int c = 0; c < channels; ++c) {
        const int i = 2 * x * channels + c;
        out[x * channels + c] =
            static_cast<std::uint8_t>((a[i] + a[i + channels] + b[i] + b[i + channels] + 2) / 4);
      }
    }
  }
  return to;
}

void RequireSize(const std::string& eye, const Pinhole& camera, int halvings) {
  const int least = kLeastPicture_px << std::min(halvings, 20);
  for (const auto& [field, value] :
       {std::pair("width", camera.width), std::pair("height", camera.height)}) {
    if (value >= least) continue;
    std::string rule = ": must be " + std::to_string(least) + " px or more";
    if (halvings > 0) rule += " where fx is " + std::to_string(std::lround(camera.fx)) + " px";
    throw std::invalid_argument("rig: " + eye + "." + field + ": " + std::to_string(value) + rule +
                                " for estimator refined");
  }
}

int Down(double px, int limit) {
  return std::clamp(static_cast<int>(std::floor(px / kBoxGrid)) * kBoxGrid, 0, limit);
}

}  // namespace

WorkingPair::WorkingPair(const StereoRig& rig, double distance_m)
    : halvings_(HalvingsFor(rig.right, distance_m)),
      eyes_{EyeGeometry(Halved(rig.right, halvings_), RigidTransform::Identity()),
            EyeGeometry(Halved(rig.left, halvings_), rig.X_CL)} {
  RequireSize("right", rig.right, halvings_);
  RequireSize("left", rig.left, halvings_);
}

std::optional<ImageView> WorkingPair::Picture(const StereoFrame& frame, std::size_t i) {
  std::optional<ImageView> picture = i == 0 ? frame.right : frame.left;
  if (!picture) return picture;
  for (int k = 0; k < halvings_; ++k) {
    picture = Halve(*picture, k % 2 == 0 ? &halved_[i] : &scratch_[i]);
  }
  return picture;
}

PixelBox WorkingPair::WholeBox(std::size_t i) const {
  return {0, 0, eyes_[i].width / kBoxGrid * kBoxGrid, eyes_[i].height / kBoxGrid * kBoxGrid};
}

PixelBox WorkingPair::BoxAround(std::size_t i, const RigidTransform& X_CM, double radius_m) const {
  const EyeGeometry& eye = eyes_[i];
  const Eigen::Vector3d p = (eye.R_EC * X_CM.translation().cast<float>() + eye.p_EC).cast<double>();
  const PixelBox whole = WholeBox(i);
  // Seen along an axis the sphere is a disc, and the rays that touch it bound its picture.
  const auto bounds = [&](double across, double focal, double centre, int limit) {
    const double distance = std::hypot(across, p.z());
    const double middle = std::atan2(across, p.z());
    const double half = std::asin(std::min(radius_m / distance, 1.0));
    return std::pair(Down(centre + focal * std::tan(middle - half), limit),
                     Down(centre + focal * std::tan(middle + half) + kBoxGrid, limit));
  };
  if (p.z() - radius_m < 0.1) return whole;
  const auto [x0, x1] = bounds(p.x(), eye.fx, eye.cx, whole.x1);
  const auto [y0, y1] = bounds(p.y(), eye.fy, eye.cy, whole.y1);
  return {x0, y0, x1, y1};
}

}  // namespace visavis
