// What is known of heads before one is seen.
#include "services/recogniser/refined/adult_head.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "services/recogniser/refined/icosphere.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

const AdultLooks& Looks() { return TheAdult().looks; }

TEST(AdultHeadTest, IsAsHighAndWideAsAHead) {
  const HeadSurface& surface = TheAdult().surface;
  const auto width = [&](const Vector3f& a) { return surface.Radius(a) + surface.Radius(-a); };
  EXPECT_NEAR(width(Vector3f::UnitX()), 0.155f, 0.02f);
  EXPECT_NEAR(width(Vector3f::UnitY()), 0.235f, 0.04f);
  EXPECT_NEAR(width(Vector3f::UnitZ()), 0.195f, 0.03f);
}

TEST(AdultHeadTest, LeftAndRightAreAlike) {
  const HeadSurface& surface = TheAdult().surface;
  const Icosphere sphere(3);
  for (const Vector3f& d : sphere.vertices()) {
    const Vector3f mirrored(-d.x(), d.y(), d.z());
    EXPECT_NEAR(surface.Radius(d), surface.Radius(mirrored), 5e-4f);
    EXPECT_NEAR(surface.Sigma(d), surface.Sigma(mirrored), 1e-3f);
  }
  for (float x = 0; x < 0.05f; x += 0.007f) {
    for (float y = -0.02f; y < 0.09f; y += 0.011f) {
      for (std::size_t band = 0; band < kNumBands; ++band)
        EXPECT_NEAR(Looks().At(x, y).mean[band], Looks().At(-x, y).mean[band], 0.05f);
    }
  }
}

TEST(AdultHeadTest, FacesDifferLessThanHairDoes) {
  const HeadSurface& surface = TheAdult().surface;
  const float cheek = surface.Sigma(Vector3f(0.03f, 0.04f, -0.09f).normalized());
  const float crown = surface.Sigma(-Vector3f::UnitY());
  EXPECT_GT(cheek, 0.0005f);
  EXPECT_LT(cheek, 0.005f);
  EXPECT_GT(crown, 1.5f * cheek);
}

TEST(AdultHeadTest, HairIsOnTopAndTheFaceIsBare) {
  const HeadSurface& surface = TheAdult().surface;
  EXPECT_GT(surface.HairSide(surface.Onto({0, -0.1f, 0.02f})), 0);
  EXPECT_LT(surface.HairSide(surface.Onto({0, 0.04f, -0.09f})), 0);
}

TEST(AdultHeadTest, ShapesDifferByMillimetresInTheFaceAlone) {
  const Eigen::MatrixXd& modes = TheAdult().shape_modes_m;
  const Icosphere sphere(Icosphere::LevelOf(static_cast<std::size_t>(modes.rows())));
  ASSERT_GT(modes.cols(), 5);
  for (Eigen::Index i = 0; i < modes.rows(); ++i) {
    if (sphere.vertices()[static_cast<std::size_t>(i)].z() > 0) {
      EXPECT_TRUE(modes.row(i).isZero()) << i;
    }
    EXPECT_LT(modes.row(i).norm(), 0.015) << i;
  }
  for (Eigen::Index k = 1; k < modes.cols(); ++k)  // largest first, but for the taper
    EXPECT_LT(modes.col(k).norm(), 1.2 * modes.col(k - 1).norm()) << k;
}

TEST(AdultHeadTest, EyesAreDarkCheeksAreNot) {
  const HeadShape& s = TheAdult().surface.shape();
  for (std::size_t band = 0; band < kNumBands; ++band) {
    const auto darkest = [&](float x, float y) {
      float least = 1e9f;
      for (float dy = -0.006f; dy < 0.007f; dy += 0.002f)
        least = std::min(least, Looks().At(x, y + dy).mean[band]);
      return least;
    };
    const float cheek = Looks().At(0.035f, 0.050f).mean[band];
    EXPECT_LT(darkest(s.eye_x, s.eye_y), cheek - 0.3f);
    EXPECT_LT(darkest(0, s.mouth_y), cheek - 0.1f);
  }
}

TEST(AdultHeadTest, BetweenCellsIsTheirMean) {
  AdultLooks looks{2, 2, -0.01f, 0.02f, 0.01f, std::vector<AdultLooks::Place>(4)};
  for (std::size_t i = 0; i < 4; ++i) {
    looks.cells[i].known = true;
    looks.cells[i].mean = {static_cast<float>(i), 10.0f * static_cast<float>(i)};
    looks.cells[i].modes[3] = static_cast<float>(i * i);
  }
  const AdultLooks::Place middle = looks.At(-0.005f, 0.025f);
  EXPECT_TRUE(middle.known);
  EXPECT_NEAR(middle.mean[kFineBand], 1.5f, 1e-4f);
  EXPECT_NEAR(middle.mean[kCoarseBand], 15, 1e-3f);
  EXPECT_NEAR(middle.modes[3], 14.0f / 4, 1e-4f);
  EXPECT_NEAR(looks.At(-0.0099f, 0.0201f).mean[kFineBand], 0, 0.05f);
}

TEST(AdultHeadTest, OutsideNothingIsKnown) {
  for (const auto& [x, y] : {std::pair(0.2f, 0.0f), {-0.2f, 0.0f}, {0.0f, 0.3f}, {0.0f, -0.3f}})
    EXPECT_FALSE(Looks().At(x, y).known);
  AdultLooks looks{2, 2, 0, 0, 1, std::vector<AdultLooks::Place>(4)};
  for (std::size_t i = 0; i < 3; ++i) looks.cells[i].known = true;
  EXPECT_FALSE(looks.At(0.5f, 0.5f).known);  // one corner is not
}

}  // namespace
}  // namespace visavis
