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
constexpr int kLargestWindow_px = 1024;  ///< doubled
constexpr std::size_t kMostChannels = 3;

std::size_t PixelsOf(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

/// Below 0: doublings.
int HalvingsFor(const Pinhole& camera, double distance_m) {
  const double ratio = camera.fx / (distance_m * kPixelsPerM);
  return static_cast<int>(std::lround(std::log2(ratio)));
}

/// Of a window, doubled, whose middle is @p half_px from what it must show at most.
int WindowFor(int picture_px, double half_px) {
  const int needed = static_cast<int>(std::ceil(4 * half_px / kBoxGrid)) * kBoxGrid;
  return std::min(needed, 2 * picture_px / kBoxGrid * kBoxGrid);
}

/// How far from where @p eye sees the middle of @p space it sees a head there at most: across,
/// down [px].
Eigen::Vector2d HalfView(const EyeGeometry& eye, const SearchSpace& space) {
  const auto see = [&](const Eigen::Vector3d& p_C) -> Eigen::Vector3d {
    return (eye.R_EC * p_C.cast<float>() + eye.p_EC).cast<double>();
  };
  const Eigen::Vector3d middle = see(space.middle().head<3>());
  const Eigen::Array2d focal(eye.fx, eye.fy);
  Eigen::Array2d half(0, 0);
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d p_C;
    for (int k = 0; k < 3; ++k) p_C[k] = (corner >> k & 1) == 0 ? space.min[k] : space.max[k];
    const Eigen::Vector3d p = see(p_C);
    const double z = std::max(p.z(), kHeadRadius_m);
    const Eigen::Array2d aside =
        focal * (p.head<2>().array() / z - middle.head<2>().array() / middle.z()).abs();
    half = half.max(aside + focal * kHeadRadius_m / z);
  }
  return half;
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

/// Row @p y of @p to, from @p box.x0 to box.x1, of the picture @p from doubled, bilinear: a pixel
/// becomes four, whose centres lie a quarter of it from its own. @p corner: of @p to in @p from.
void DoubleRow(const ImageView& from, const std::array<int, 2>& corner, const PixelBox& box, int y,
               std::vector<std::uint16_t>* blended, const ImageView& to, std::uint8_t* out) {
  const int channels = BytesPerPixel(from.format);
  const auto clamp = [](int i, int limit) { return std::clamp(i, 0, limit - 1); };
  const int near_y = corner[1] + y / 2, far_y = y % 2 == 0 ? near_y - 1 : near_y + 1;
  const std::uint8_t *near = from.row(clamp(near_y, from.height)),
                     *far = from.row(clamp(far_y, from.height));
  // One pixel more on both sides.
  const int first = corner[0] + box.x0 / 2 - 1, count = box.width() / 2 + 2;
  blended->resize(static_cast<std::size_t>(count * channels));
  std::uint16_t* row = blended->data();
  for (int x = 0; x < count; ++x) {
    const int i = clamp(first + x, from.width) * channels;
    for (int c = 0; c < channels; ++c)
      row[x * channels + c] = static_cast<std::uint16_t>(3 * near[i + c] + far[i + c]);
  }
  out += std::ptrdiff_t{y} * to.stride + std::ptrdiff_t{channels} * box.x0;
  for (int x = 1; x + 1 < count; ++x, out += 2 * channels) {
    const std::uint16_t* middle = row + x * channels;
    for (int c = 0; c < channels; ++c) {
      const int thrice = 3 * middle[c] + 8;
      out[c] = static_cast<std::uint8_t>((thrice + middle[c - channels]) / 16);
      out[c + channels] = static_cast<std::uint8_t>((thrice + middle[c + channels]) / 16);
    }
  }
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
    : halvings_(std::max(0, HalvingsFor(rig.right, distance_m))),
      cameras_{rig.right, rig.left},
      eyes_{EyeGeometry(Halved(rig.right, halvings_), RigidTransform::Identity()),
            EyeGeometry(Halved(rig.left, halvings_), rig.X_CL)} {
  RequireSize("right", rig.right, halvings_);
  RequireSize("left", rig.left, halvings_);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t half = kMostChannels * PixelsOf(cameras_[i].width, cameras_[i].height) / 4;
    if (halvings_ > 0) halved_[i].reserve(half);
    if (halvings_ > 1) scratch_[i].reserve(half / 4);
  }
}

WorkingPair::WorkingPair(const StereoRig& rig, const SearchSpace& space)
    : WorkingPair(rig, space.distance()) {
  if (HalvingsFor(rig.right, space.distance()) >= 0) return;
  std::array<EyeGeometry, 2> doubled = eyes_;
  for (EyeGeometry& eye : doubled) {
    const Eigen::Vector2d half = HalfView(eye, space);
    eye.width = WindowFor(eye.width, half.x());
    eye.height = WindowFor(eye.height, half.y());
    if (!(half.maxCoeff() < kLargestWindow_px) || eye.width > kLargestWindow_px ||
        eye.height > kLargestWindow_px || eye.width < kBoxGrid || eye.height < kBoxGrid)
      return;
    eye.fx *= 2;
    eye.fy *= 2;
  }
  is_doubled_ = true;
  eyes_ = doubled;
  for (std::size_t i = 0; i < 2; ++i)
    halved_[i].reserve(kMostChannels * PixelsOf(eyes_[i].width, eyes_[i].height));
  blended_.reserve(kMostChannels * static_cast<std::size_t>(kLargestWindow_px));
  LookAt(space.middle().head<3>());
}

void WorkingPair::LookAt(const Eigen::Vector3d& p_C) {
  if (!is_doubled_) return;
  for (std::size_t i = 0; i < 2; ++i) {
    EyeGeometry& eye = eyes_[i];
    const Pinhole& camera = cameras_[i];
    const Eigen::Vector3d p = (eye.R_EC * p_C.cast<float>() + eye.p_EC).cast<double>();
    const auto corner = [&](double focal, double centre, double across, int window, int picture) {
      const double middle = p.z() > 0 ? centre + focal * across / p.z() : centre;
      const double first = std::isfinite(middle) ? middle - window / 4.0 : 0;
      return static_cast<int>(std::lround(std::clamp(first, 0.0, picture - window / 2.0)));
    };
    corners_[i] = {corner(camera.fx, camera.cx, p.x(), eye.width, camera.width),
                   corner(camera.fy, camera.cy, p.y(), eye.height, camera.height)};
    eye.cx = static_cast<float>(2 * (camera.cx - corners_[i][0] + 0.5) - 0.5);
    eye.cy = static_cast<float>(2 * (camera.cy - corners_[i][1] + 0.5) - 0.5);
  }
}

std::optional<ImageView> WorkingPair::Picture(const StereoFrame& frame, std::size_t i) {
  std::optional<ImageView> picture = i == 0 ? frame.right : frame.left;
  if (!picture) return picture;
  sources_[i] = *picture;
  if (is_doubled_) {
    windows_[i] = *picture;
    ImageView& window = windows_[i];
    window.width = eyes_[i].width;
    window.height = eyes_[i].height;
    window.stride = window.width * BytesPerPixel(window.format);
    window.size = static_cast<std::size_t>(window.stride) * static_cast<std::size_t>(window.height);
    if (halved_[i].size() < window.size) halved_[i].resize(window.size);
    window.data = halved_[i].data();
    filled_[i] = {};
    return window;
  }
  for (int k = 0; k < halvings_; ++k) {
    picture = Halve(*picture, k % 2 == 0 ? &halved_[i] : &scratch_[i]);
  }
  return picture;
}

void WorkingPair::Fill(std::size_t i, const PixelBox& box) {
  const PixelBox& filled = filled_[i];
  const bool is_there =
      box.x0 >= filled.x0 && box.y0 >= filled.y0 && box.x1 <= filled.x1 && box.y1 <= filled.y1;
  if (!is_doubled_ || is_there) return;
  for (int y = box.y0; y < box.y1; ++y)
    DoubleRow(sources_[i], corners_[i], box, y, &blended_, windows_[i], halved_[i].data());
  filled_[i] = box;
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
