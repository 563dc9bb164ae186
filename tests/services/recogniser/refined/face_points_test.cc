#include "services/recogniser/refined/face_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/recogniser/refined/head_geometry.h"
#include "tests/support/mesh_scene.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

const FacePoints& Face() { return SharedAdultHead().face; }

/// The lowest generic brightness within @p radius of (x, y), seen from the front.
float Darkest(Band band, float x, float y, float radius) {
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < Face().size(); ++i) {
    const Vector3f& p = Face().points[i];
    if (Face().has_generic[i] && std::hypot(p.x() - x, p.y() - y) < radius)
      least = std::min(least, Face().generic[band][i]);
  }
  return least;
}

/// The mean within @p radius.
float Mean(Band band, float x, float y, float radius) {
  float sum = 0;
  int n = 0;
  for (std::size_t i = 0; i < Face().size(); ++i) {
    const Vector3f& p = Face().points[i];
    if (!Face().has_generic[i] || std::hypot(p.x() - x, p.y() - y) >= radius) continue;
    sum += Face().generic[band][i];
    ++n;
  }
  EXPECT_GT(n, 0);
  return sum / static_cast<float>(n);
}

TEST(FacePointsTest, EveryListHasTheSameLength) {
  const std::size_t n = Face().size();
  EXPECT_GT(n, 300u);
  EXPECT_EQ(Face().normals.size(), n);
  EXPECT_EQ(Face().has_generic.size(), n);
  for (const auto& band : Face().generic) EXPECT_EQ(band.size(), n);
}

TEST(FacePointsTest, PointsLieOnTheSurfaceInFrontAndBelowTheHair) {
  const HeadSurface& surface = SharedAdultHead().surface;
  for (std::size_t i = 0; i < Face().size(); ++i) {
    const Vector3f& p = Face().points[i];
    EXPECT_NEAR(p.norm(), surface.Radius(p.normalized()), 2e-6f);
    EXPECT_LT(surface.HairSide(p), 0);
    EXPECT_LT(Face().normals[i].z(), 0);
    EXPECT_NEAR(Face().normals[i].norm(), 1, 1e-5f);
    EXPECT_GT(Face().normals[i].dot(p), 0);
  }
}

TEST(FacePointsTest, PointsOfAHeadWhoseHalvesDifferLieOnItTooOnBothSides) {
  HeadTable table = TableOf(SharedAdultHead().surface, 3);
  const Icosphere sphere(3);
  for (std::size_t i = 0; i < table.radii_m.size(); ++i)
    table.radii_m[i] += 0.01f * sphere.vertices()[i].x();
  const HeadSurface surface(HeadShape{}, table);
  const FacePoints face = FacePointsOf(surface, 0.01);
  EXPECT_GT(face.size(), 80u);
  for (const Vector3f& p : face.points)
    EXPECT_NEAR(p.norm(), surface.Radius(p.normalized()), 2e-6f);
}

TEST(FacePointsTest, NeighboursAreAboutTheSpacingApart) {
  for (const double spacing : {0.005, 0.010}) {
    const FacePoints face = FacePointsOf(SharedAdultHead().surface, spacing);
    std::vector<float> nearest;
    for (const Vector3f& p : face.points) {
      float best = 1;
      for (const Vector3f& q : face.points) {
        const float d = (p - q).norm();
        if (d > 0) best = std::min(best, d);
      }
      nearest.push_back(best);
    }
    std::sort(nearest.begin(), nearest.end());
    EXPECT_NEAR(nearest[nearest.size() / 2], spacing, 0.25 * spacing);
    EXPECT_GT(nearest.front(), 0.2 * spacing);
  }
}

TEST(FacePointsTest, LeftAndRightAreAlike) {
  for (std::size_t i = 0; i < Face().size(); ++i) {
    const Vector3f& p = Face().points[i];
    const auto twin = std::find_if(
        Face().points.begin(), Face().points.end(),
        [&](const Vector3f& q) { return (q - Vector3f(-p.x(), p.y(), p.z())).norm() < 1e-6f; });
    ASSERT_NE(twin, Face().points.end());
    const auto j = static_cast<std::size_t>(twin - Face().points.begin());
    EXPECT_EQ(Face().has_generic[i], Face().has_generic[j]);
    for (const auto& band : Face().generic) EXPECT_NEAR(band[i], band[j], 1e-4f);
  }
}

TEST(FacePointsTest, EyesAndBrowsAreDarkInBothBands) {
  const HeadShape& s = SharedAdultHead().surface.shape();
  for (const Band band : {kFineBand, kCoarseBand}) {
    for (const float side : {-1.0f, 1.0f}) {
      EXPECT_LT(Darkest(band, side * s.eye_x, s.eye_y, 0.006f), -0.15f);
      // The brow's outer end, away from the lids.
      EXPECT_LT(Darkest(band, side * 0.047f, s.brow_y, 0.004f), -0.1f);
    }
    EXPECT_LT(Darkest(band, 0, s.mouth_y, 0.008f), -0.08f);
  }
}

TEST(FacePointsTest, CheeksAreBrighterThanEyesAndMouth) {
  const HeadShape& s = SharedAdultHead().surface.shape();
  for (const Band band : {kFineBand, kCoarseBand}) {
    const float cheek = Mean(band, 0.035f, 0.050f, 0.008f);
    EXPECT_GT(cheek, Mean(band, s.eye_x, s.eye_y, 0.008f) + 0.1f);
    EXPECT_GT(cheek, Mean(band, 0, s.mouth_y, 0.005f) + 0.05f);
  }
}

TEST(FacePointsTest, TheGenericFaceIsAboutZeroInTheMean) {
  for (const auto& band : Face().generic) {
    double sum = 0, sum_square = 0;
    int n = 0;
    for (std::size_t i = 0; i < Face().size(); ++i) {
      if (!Face().has_generic[i]) continue;
      sum += static_cast<double>(band[i]);
      sum_square += static_cast<double>(band[i] * band[i]);
      ++n;
    }
    const double rms = std::sqrt(sum_square / n);
    EXPECT_GT(rms, 0.02);
    EXPECT_LT(std::abs(sum / n), 0.3 * rms);
  }
}

TEST(FacePointsTest, WhereTheGenericFaceSaysNothingItIsZero) {
  int silent = 0;
  for (std::size_t i = 0; i < Face().size(); ++i) {
    if (Face().has_generic[i]) {
      EXPECT_LT(std::abs(Face().points[i].x()), 0.056f);
      continue;
    }
    ++silent;
    for (const auto& band : Face().generic) EXPECT_EQ(band[i], 0);
  }
  EXPECT_GT(silent, 50);
}

TEST(FacePointsTest, FeaturesFollowTheShape) {
  const HeadTable table = TableOf(SharedAdultHead().surface, 4);
  HeadShape shape;
  shape.eye_y += 0.010f;
  shape.eye_x += 0.006f;
  const FacePoints lower = FacePointsOf(HeadSurface(shape, table), 0.005);
  // The middle of the darkness round a pupil.
  const auto pupil = [](const FacePoints& face, const Eigen::Vector2f& near) {
    Eigen::Vector2f weighted = Eigen::Vector2f::Zero();
    float sum = 0;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Eigen::Vector2f p = face.points[i].head<2>();
      if (!face.has_generic[i] || (p - near).norm() > 0.014f) continue;
      const float dark = std::max(0.0f, -face.generic[kFineBand][i]);
      sum += dark;
      weighted += dark * p;
    }
    return Eigen::Vector2f(weighted / sum);
  };
  const HeadShape adult;
  const Eigen::Vector2f moved =
      pupil(lower, {shape.eye_x, shape.eye_y}) - pupil(Face(), {adult.eye_x, adult.eye_y});
  EXPECT_NEAR(moved.x(), 0.006f, 0.003f);
  EXPECT_NEAR(moved.y(), 0.010f, 0.003f);
}

TEST(FacePointsTest, FacesDifferWhereTheGenericOneSaysAnything) {
  ASSERT_EQ(Face().doubt.size(), Face().size());
  ASSERT_EQ(Face().modes.size(), Face().size());
  for (std::size_t i = 0; i < Face().size(); ++i) {
    if (!Face().has_generic[i]) continue;
    EXPECT_GT(Face().doubt[i], 0.02f);
    EXPECT_LT(Face().doubt[i], 3);
  }
}

}  // namespace
}  // namespace visavis
