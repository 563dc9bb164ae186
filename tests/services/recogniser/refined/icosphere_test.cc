#include "services/recogniser/refined/icosphere.h"

#include <gtest/gtest.h>

#include <map>

#include "common/core/random.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

TEST(IcosphereTest, EachLevelHasItsNumberOfUnitVertices) {
  for (int level = 0; level <= 4; ++level) {
    const Icosphere sphere(level);
    EXPECT_EQ(sphere.vertices().size(), 10u * (1u << (2 * level)) + 2);
    EXPECT_EQ(sphere.triangles().size(), 20u * (1u << (2 * level)));
    EXPECT_EQ(Icosphere::LevelOf(sphere.vertices().size()), level);
    EXPECT_EQ(sphere.level(), level);
    for (const Vector3f& v : sphere.vertices()) EXPECT_NEAR(v.norm(), 1, 1e-6f);
  }
  EXPECT_EQ(Icosphere::LevelOf(2561), -1);
  EXPECT_THROW(Icosphere(-1), std::invalid_argument);
  EXPECT_THROW(Icosphere(Icosphere::kMaxLevel + 1), std::invalid_argument);
}

TEST(IcosphereTest, ItIsClosedAndTurnedOutwards) {
  const Icosphere sphere(3);
  std::map<std::pair<int, int>, int> edges;
  for (const auto& [a, b, c] : sphere.triangles()) {
    for (const auto& edge : {std::pair{a, b}, std::pair{b, c}, std::pair{c, a}}) ++edges[edge];
    const auto at = [&](int i) { return sphere.vertices()[static_cast<std::size_t>(i)]; };
    EXPECT_GT((at(b) - at(a)).cross(at(c) - at(a)).dot(at(a)), 0);
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
}

TEST(IcosphereTest, ThePlaceOfADirectionLiesOnItsRay) {
  const Icosphere sphere(4);
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    Vector3f d(static_cast<float>(random.Uniform(-1, 1)), static_cast<float>(random.Uniform(-1, 1)),
               static_cast<float>(random.Uniform(-1, 1)));
    if (d.norm() < 0.05f) continue;
    const Icosphere::Place place = sphere.Locate(d);
    Vector3f p = Vector3f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_GE(place.weights[static_cast<int>(k)], 0);
      p += place.weights[static_cast<int>(k)] *
           sphere.vertices()[static_cast<std::size_t>(place.corners[k])];
    }
    EXPECT_NEAR(place.weights.sum(), 1, 1e-5f);
    EXPECT_LT((p.normalized() - d.normalized()).norm(), 1e-5f);
  }
}

TEST(IcosphereTest, AVertexIsFoundAtItself) {
  const Icosphere sphere(4);
  for (std::size_t i = 0; i < sphere.vertices().size(); ++i) {
    for (const float length : {1.0f, 2.0f, 0.1f, 0.0928351f}) {
      const Icosphere::Place place = sphere.Locate(length * sphere.vertices()[i]);
      float own = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        if (place.corners[k] == static_cast<int>(i)) own = place.weights[static_cast<int>(k)];
      }
      EXPECT_GT(own, 0.9999f) << i;
    }
  }
}

TEST(IcosphereTest, WhatWasFoundLastSpeedsUpTheSearchAndChangesNothing) {
  const Icosphere sphere(4);
  Random random(3);
  std::size_t triangle = 7;
  Eigen::Vector3f direction(0, 0, 1);
  for (int i = 0; i < 2000; ++i) {
    const float step = i % 10 == 0 ? 2.0f : 0.02f;
    const auto move = [&] { return step * static_cast<float>(random.Uniform() - 0.5); };
    direction += Eigen::Vector3f(move(), move(), move());
    const Icosphere::Place near = sphere.LocateNear(direction, &triangle);
    const Icosphere::Place place = sphere.Locate(direction);
    ASSERT_EQ(near.corners, place.corners) << i;
    ASSERT_EQ(near.weights, place.weights) << i;
    ASSERT_EQ(sphere.triangles()[triangle], place.corners) << i;
  }
}

}  // namespace
}  // namespace visavis
