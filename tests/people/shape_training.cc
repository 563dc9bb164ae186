#include "tests/people/shape_training.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "services/recogniser/refined/icosphere.h"
#include "tests/people/hair_border.h"
#include "tests/people/weighted.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr int kLevel = 4, kModes = 20;
constexpr double kCap = 4;  ///< standard deviations that one head may be off
// Of faces without hair, where the surface is theirs; 0 to 1 over kTaper_m inside of the border.
constexpr float kHalfBreadth_m = 0.075f, kTop_m = -0.055f, kBottom_m = 0.120f, kRear_m = -0.015f;
constexpr float kTaper_m = 0.015f;
constexpr double kLeastShare = 0.01;  ///< below it modes would be written as 0

/// Share that the bare face has in the surface at @p p.
float BareShare(const Vector3f& p) {
  const float inside = std::min(
      {kHalfBreadth_m - std::abs(p.x()), p.y() - kTop_m, kBottom_m - p.y(), kRear_m - p.z()});
  return std::clamp(inside / kTaper_m, 0.0f, 1.0f);
}

/// For each vertex that at the other side of x = 0.
std::vector<std::size_t> MirrorOf(const Icosphere& sphere) {
  const std::vector<Vector3f>& vertices = sphere.vertices();
  std::vector<std::size_t> mirror(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector3f other(-vertices[i].x(), vertices[i].y(), vertices[i].z());
    float nearest = std::numeric_limits<float>::max();
    for (std::size_t k = 0; k < vertices.size(); ++k) {
      const float d = (vertices[k] - other).squaredNorm();
      if (d < nearest) {
        nearest = d;
        mirror[i] = k;
      }
    }
  }
  return mirror;
}

/// One head by direction.
struct HeadRadii {
  std::vector<float> bare;
  std::vector<HeadScan::Outermost> dressed;
};

HeadRadii RadiiOf(const AlignedHead& head, const Icosphere& sphere) {
  HeadRadii radii;
  for (const Vector3f& direction : sphere.vertices()) {
    radii.bare.push_back(head.scan->BareRadius(head.X_TM, direction));
    radii.dressed.push_back(head.scan->OutermostAt(head.X_TM, direction));
  }
  return radii;
}

/// What the heads have in a direction and its mirror image.
struct Direction {
  WeightedValues bare, dressed, is_hair;
};

Direction Collect(const std::vector<AlignedHead>& heads, const std::vector<HeadRadii>& radii,
                  const std::array<std::size_t, 2>& sides) {
  Direction direction;
  for (std::size_t h = 0; h < heads.size(); ++h) {
    for (const std::size_t i : sides) {
      const HeadScan::Outermost& outermost = radii[h].dressed[i];
      if (std::isfinite(radii[h].bare[i]))
        direction.bare.Add(static_cast<double>(radii[h].bare[i]), heads[h].weight);
      if (!std::isfinite(outermost.radius_m)) continue;
      direction.dressed.Add(static_cast<double>(outermost.radius_m), heads[h].weight);
      direction.is_hair.Add(outermost.is_hair ? 1 : 0, heads[h].weight);
    }
  }
  return direction;
}

}  // namespace

ShapeModel TrainShape(const std::vector<AlignedHead>& heads) {
  const Icosphere sphere(kLevel);
  const std::vector<std::size_t> mirror = MirrorOf(sphere);
  std::vector<HeadRadii> radii;
  radii.reserve(heads.size());
  for (const AlignedHead& head : heads) radii.push_back(RadiiOf(head, sphere));

  ShapeModel model;
  std::vector<double> bare_mean, share, hair;
  for (std::size_t i = 0; i < mirror.size(); ++i) {
    const Direction direction = Collect(heads, radii, {i, mirror[i]});
    const double bare = direction.bare.Mean(), dressed = direction.dressed.Median();
    const auto w = static_cast<double>(BareShare(static_cast<float>(bare) * sphere.vertices()[i]));
    bare_mean.push_back(bare);
    share.push_back(w);
    hair.push_back(direction.is_hair.Mean());
    model.table.radii_m.push_back(static_cast<float>(w * bare + (1 - w) * dressed));
    model.table.sigma_m.push_back(
        static_cast<float>(direction.dressed.Deviation(w * bare + (1 - w) * dressed, kCap)));
    if (w > kLeastShare) model.region.push_back(static_cast<int>(i));
  }
  model.table.hair_side_m = HairSides(sphere, model.table.radii_m, hair);

  const auto n = static_cast<Eigen::Index>(heads.size());
  Eigen::MatrixXd deviations(static_cast<Eigen::Index>(model.region.size()), 2 * n);
  Eigen::VectorXd weights(2 * n), taper(deviations.rows());
  for (Eigen::Index row = 0; row < deviations.rows(); ++row) {
    const auto i = static_cast<std::size_t>(model.region[static_cast<std::size_t>(row)]);
    taper[row] = share[i];
    for (Eigen::Index h = 0; h < n; ++h) {
      const std::vector<float>& bare = radii[static_cast<std::size_t>(h)].bare;
      for (const auto& [column, k] : {std::pair(h, i), std::pair(n + h, mirror[i])}) {
        const auto radius = static_cast<double>(bare[k]);
        deviations(row, column) = std::isfinite(radius) ? radius - bare_mean[i] : 0;
        weights[column] = 0.5 * heads[static_cast<std::size_t>(h)].weight;
      }
    }
  }
  model.modes_m = taper.asDiagonal() * PrincipalModes(deviations, weights, kModes);
  return model;
}

}  // namespace visavis
