#include "services/recogniser/head_model.h"

#include <algorithm>
#include <cmath>

#include "common/config/config_error.h"
#include "common/core/check.h"

namespace visavis {
namespace {

constexpr int kInRings = 8, kInPerRing = 24;
constexpr int kOutRings = 2, kOutPerRing = 48;
constexpr int kPointsAlong = 8;  // along each strip of a brow or an eye
// F_out's strips, in half heights of a brow and in scales of an eye.
constexpr double kBrowOut = 2.2;
constexpr double kEyeOut[] = {1.35, 1.6};

double Radians(double deg) { return deg * M_PI / 180; }

}  // namespace

void HeadModelConfig::ValidateOrThrow(const std::string& prefix) const {
  const auto require = [&](bool holds, const char* key, double value, const char* rule) {
    if (!holds) throw FieldError(prefix + key, std::to_string(value), rule);
  };
  const bool sphere = shape == "sphere";
  const double a_mm = sphere ? radius_mm : semi_axis_x_mm;
  const double b_mm = sphere ? radius_mm : semi_axis_y_mm;
  const double c_mm = sphere ? radius_mm : semi_axis_z_mm;
  // Whether the front of the head, short of its outline, reaches so far from the middle.
  const auto reaches = [&](double x_mm, double y_mm) {
    return std::hypot(x_mm / a_mm, y_mm / b_mm) < 0.9;
  };
  require(brow_outer_x_mm > brow_inner_x_mm, "brow_outer_x_mm", brow_outer_x_mm,
          "must exceed brow_inner_x_mm");
  require(brow_y_mm < eye_y_mm, "brow_y_mm", brow_y_mm,
          "must lie above the eye: below eye_y_mm in value");
  require(reaches(eye_x_mm + kEyeOut[1] * eye_half_width_mm,
                  std::abs(eye_y_mm) + kEyeOut[1] * eye_half_height_mm),
          "eye_x_mm", eye_x_mm, "the eye must lie on the front of the head");
  const double brow_reach_mm = std::max(std::abs(brow_y_mm), std::abs(brow_y_mm - brow_arch_mm)) +
                               kBrowOut * brow_half_height_mm;
  require(reaches(brow_outer_x_mm, brow_reach_mm), "brow_outer_x_mm", brow_outer_x_mm,
          "the brow must lie on the front of the head");
  const double tilt = Radians(hair_tilt_deg);
  require(std::abs(hair_offset_mm) < std::hypot(b_mm * std::cos(tilt), c_mm * std::sin(tilt)),
          "hair_offset_mm", hair_offset_mm, "the plane must cut the head");
}

HeadModel::HeadModel(const HeadModelConfig& config) {
  config.ValidateOrThrow("head.");
  semi_axes_m_ =
      config.shape == "sphere"
          ? Eigen::Vector3d::Constant(config.radius_mm)
          : Eigen::Vector3d(config.semi_axis_x_mm, config.semi_axis_y_mm, config.semi_axis_z_mm);
  semi_axes_m_ /= 1000;
  const double tilt = Radians(config.hair_tilt_deg);
  hair_normal_ = {0, -std::cos(tilt), std::sin(tilt)};
  hair_offset_m_ = config.hair_offset_mm / 1000;
  MakeDisc(config);
  MakeFeatures(config);
  VISAVIS_THROW_UNLESS(num_points() % kLanes == 0, num_points());
}

// Rings of equal area inside; evenly spaced rings outside, without the sector of the neck.
void HeadModel::MakeDisc(const HeadModelConfig& config) {
  const auto add = [](double radius, double angle, std::vector<float>* u, std::vector<float>* v) {
    u->push_back(static_cast<float>(radius * std::cos(angle)));
    v->push_back(static_cast<float>(radius * std::sin(angle)));
  };
  for (int ring = 0; ring < kInRings; ++ring) {
    const double radius = std::sqrt((ring + 0.5) / kInRings);
    for (int i = 0; i < kInPerRing; ++i) {
      add(radius, 2 * M_PI * (i + 0.5 * (ring % 2)) / kInPerRing, &in_u, &in_v);
    }
  }
  const double gap = Radians(config.chin_gap_deg);  // centred on straight down, v = +1
  for (int ring = 0; ring < kOutRings; ++ring) {
    const double radius = 1 + config.outline_width * (ring + 0.5) / kOutRings;
    for (int i = 0; i < kOutPerRing; ++i) {
      const double angle = M_PI / 2 + gap / 2 + (2 * M_PI - gap) * (i + 0.5) / kOutPerRing;
      add(radius, angle, &out_u, &out_v);
    }
  }
}

void HeadModel::AddFeature(double x_mm, double y_mm) {
  const double x = x_mm / 1000, y = y_mm / 1000;
  const double rest = 1 - std::pow(x / semi_axes_m_.x(), 2) - std::pow(y / semi_axes_m_.y(), 2);
  VISAVIS_THROW_UNLESS(rest > 0, rest);
  feature_x.push_back(static_cast<float>(x));
  feature_y.push_back(static_cast<float>(y));
  feature_z.push_back(static_cast<float>(-semi_axes_m_.z() * std::sqrt(rest)));
}

// F_in: two rows within each brow, two rings within each eye. F_out: a row above and below each
// brow, two rings around each eye.
void HeadModel::MakeFeatures(const HeadModelConfig& c) {
  const auto brow = [&](double side, double dy_mm) {
    for (int i = 0; i < kPointsAlong; ++i) {
      const double s = (i + 0.5) / kPointsAlong;
      const double x = c.brow_inner_x_mm + s * (c.brow_outer_x_mm - c.brow_inner_x_mm);
      const double arch = c.brow_arch_mm * (1 - std::pow(2 * s - 1, 2));
      AddFeature(side * x, c.brow_y_mm - arch + dy_mm);
    }
  };
  const auto eye = [&](double side, double scale) {
    for (int i = 0; i < kPointsAlong; ++i) {
      const double angle = 2 * M_PI * (i + 0.5) / kPointsAlong;
      AddFeature(side * (c.eye_x_mm + scale * c.eye_half_width_mm * std::cos(angle)),
                 c.eye_y_mm + scale * c.eye_half_height_mm * std::sin(angle));
    }
  };
  for (const double side : {-1.0, 1.0}) {
    for (const double dy : {-0.5, 0.5}) brow(side, dy * c.brow_half_height_mm);
    for (const double scale : {0.35, 0.75}) eye(side, scale);
  }
  num_feature_in_ = static_cast<int>(feature_x.size());
  for (const double side : {-1.0, 1.0}) {
    for (const double dy : {-kBrowOut, kBrowOut}) brow(side, dy * c.brow_half_height_mm);
    for (const double scale : kEyeOut) eye(side, scale);
  }
}

}  // namespace visavis
