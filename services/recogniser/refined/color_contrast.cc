#include "services/recogniser/refined/color_contrast.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr int kShift = 5, kBins = 512;  ///< eight levels of each colour
constexpr float kFacing = 0.3f, kGrazing = 0.2f;
constexpr std::array<float, 2> kBeyond_m = {0.014f, 0.030f};
constexpr int kInsideStep = 2;  ///< one point in so many
constexpr double kSkinShare = 0.6;
constexpr int kFewest = 10;  ///< points of a kind that tell anything

struct Histogram {
  std::array<std::int32_t, kBins> bins{};
  std::int32_t total{0};

  void Add(int bin) {
    ++bins[static_cast<std::size_t>(bin)];
    ++total;
  }
  /// 1 less what both have in common.
  double Differs(const Histogram& other) const {
    if (total < kFewest || other.total < kFewest) return 0;
    std::int32_t common = 0;  // times both totals, which are some hundreds
    for (std::size_t i = 0; i < bins.size(); ++i)
      common += std::min(bins[i] * other.total, other.bins[i] * total);
    return 1 - static_cast<double>(common) /
                   (static_cast<double>(total) * static_cast<double>(other.total));
  }
};

}  // namespace

ColorContrast::ColorContrast(const HeadMesh& mesh) {
  int num_inside = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Point point{mesh.vertices[i], mesh.normals[i], mesh.vertices[i].dot(mesh.normals[i])};
    if (mesh.coloured[i] && num_inside++ % kInsideStep == 0)
      (mesh.parts[i] == HeadPart::kHair ? hair_ : skin_).push_back(point);
    if (mesh.contour_weights[i] > 0) outline_.push_back(point);
  }
}

double ColorContrast::Of(const ImageView& picture, const EyeGeometry& eye,
                         const RigidTransform& X_CM) const {
  const EyePose pose(eye, X_CM);
  const Channels channels(picture.format);
  Histogram skin, hair, round;
  const auto add = [&](const Vector3f& p_M, Histogram* histogram) {
    const Vector3f p = pose.InEye(p_M);
    if (!(p.z() > 0.1f)) return;
    const float u = eye.cx + eye.fx * p.x() / p.z() + 0.5f;
    const float v = eye.cy + eye.fy * p.y() / p.z() + 0.5f;
    if (!(u >= 0 && v >= 0 && u < static_cast<float>(eye.width) &&
          v < static_cast<float>(eye.height)))
      return;
    const std::uint8_t* pixel =
        picture.row(static_cast<int>(v)) + channels.step * static_cast<std::ptrdiff_t>(u);
    const auto level = [&](int channel) { return pixel[channel] >> kShift; };
    histogram->Add(level(channels.red) << 6 | level(channels.green) << 3 | level(channels.blue));
  };
  // All points are about as far from the eye as the head is.
  const float facing = kFacing * pose.p_ME.norm(), grazing = kGrazing * pose.p_ME.norm();
  const auto towards = [&](const Point& point) {
    return point.normal.dot(pose.p_ME) - point.along_normal;
  };
  for (const Point& point : skin_) {
    if (towards(point) > facing) add(point.p, &skin);
  }
  for (const Point& point : hair_) {
    if (towards(point) > facing) add(point.p, &hair);
  }
  for (const Point& point : outline_) {
    if (std::abs(towards(point)) >= grazing) continue;
    for (const float beyond : kBeyond_m) add(point.p + beyond * point.normal, &round);
  }
  return kSkinShare * skin.Differs(round) + (1 - kSkinShare) * hair.Differs(round);
}

}  // namespace visavis
