#include "services/recogniser/head_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/config/config_error.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string Numbers(int count, const std::string& number) {
  std::string list = "[";
  for (int i = 0; i < count; ++i) list += (i > 0 ? ", " : "") + number;
  return list + "]";
}

class HeadFileTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& text) {
    std::ofstream(name_) << text;
    return name_;
  }
  TemporaryFolder folder_;
  std::string name_{folder_ / "head.yaml"};
};

TEST_F(HeadFileTest, AHeadThatWasWrittenIsReadBackToAThousandthOfAMillimetre) {
  HeadShape shape;
  shape.eye_y = 0.015f;
  shape.mouth_y = 0.079f;
  const HeadGeometry head{HeadSurface(shape), {0.001, -0.02, 0.003}};
  SaveHeadFile(name_, head);
  const HeadGeometry read = LoadHeadFile(name_);
  EXPECT_NEAR(read.surface.shape().eye_y, 0.015f, 1e-6f);
  EXPECT_NEAR(read.surface.shape().mouth_y, 0.079f, 1e-6f);
  EXPECT_LT((read.p_MR_m - head.p_MR_m).norm(), 1e-9);
  const Icosphere sphere(4);
  for (const Eigen::Vector3f& d : sphere.vertices()) {
    const float r = head.surface.Radius(d);
    EXPECT_NEAR(read.surface.Radius(d), r, 1e-6f);
    EXPECT_NEAR(read.surface.HairSide(r * d), head.surface.HairSide(r * d), 1e-6f);
  }
}

TEST_F(HeadFileTest, RadiiAloneAreEnough) {
  const HeadGeometry head = LoadHeadFile(Write("radii_mm: " + Numbers(642, "95") + "\n"));
  EXPECT_NEAR(head.surface.Radius({0, 0, 1}), 0.095f, 1e-6f);
  EXPECT_NEAR(head.surface.HairSide({0, 0.1f, 0}), HeadSurface(HeadShape{}).HairSide({0, 0.1f, 0}),
              1e-4f);  // the plane of HeadShape, its tilt rounded to a degree
}

TEST_F(HeadFileTest, WhatIsNoHeadIsRefusedWithFileKeyValueAndRule) {
  const struct {
    std::string text;
    const char *key, *rule;
  } kBad[] = {
      {"", "radii_mm", "162, 642, 2562"},
      {"radii_mm: " + Numbers(641, "95"), "641 numbers", "162, 642, 2562"},
      {"radii_mm: " + Numbers(642, "0.095"), "0.095", "20 to 400 mm"},
      {"radii_mm: " + Numbers(642, ".nan"), "nan", "20 to 400 mm"},
      {"radii_mm: " + Numbers(642, "95") + "\nhair_side_mm: [1, 2]", "2 numbers", "as many as"},
      {"radii_mm: " + Numbers(642, "95") + "\norigin_mm: [1, 2]", "origin_mm", "three"},
      {"radii_mm: " + Numbers(642, "95") + "\neye_y_mm: 500", "eye_y_mm", "-60 to 80 mm"},
      {"radii_mm: " + Numbers(642, "x"), "radii_mm", "list"},
      {"radius_mm: 95", "radius_mm", ""},
      {"radii_mm: [95, 95", "head.yaml", ""},  // truncated
  };
  for (const auto& bad : kBad) {
    EXPECT_THAT([&] { LoadHeadFile(Write(bad.text)); },
                ::testing::ThrowsMessage<ConfigError>(
                    AllOf(HasSubstr("head.yaml"), HasSubstr(bad.key), HasSubstr(bad.rule))))
        << bad.text.substr(0, 60);
  }
  EXPECT_THROW(LoadHeadFile(folder_ / "none.yaml"), ConfigError);
}

TEST_F(HeadFileTest, AFolderThatIsNotThereIsNamedWhenWriting) {
  EXPECT_THAT([&] { SaveHeadFile(folder_ / "none/head.yaml", HeadGeometry{}); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("none/head.yaml")));
}

}  // namespace
}  // namespace visavis
