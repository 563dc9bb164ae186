#include "services/recogniser/head_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "common/config/config_error.h"
#include "common/core/random.h"
#include "services/recogniser/refined/adult_head.h"
#include "tests/support/config_refusal.h"
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
  const HeadGeometry head{HeadSurface(shape, TableOf(TheAdult().surface, 4)),
                          {0.001, -0.02, 0.003}};
  SaveHeadFile(name_, head);
  const HeadGeometry read = LoadHeadFile(name_);
  EXPECT_FALSE(read.is_measured);
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

TEST_F(HeadFileTest, AMeasuredHeadStaysOne) {
  const HeadSurface surface(HeadShape{}, TableOf(TheAdult().surface, 5));
  SaveHeadFile(name_, {surface, {0, 0, 0}, std::nullopt, true});
  const HeadGeometry read = LoadHeadFile(name_);
  EXPECT_TRUE(read.is_measured);
  const Icosphere sphere(5);
  for (const Eigen::Vector3f& d : sphere.vertices())
    EXPECT_NEAR(read.surface.Radius(d), surface.Radius(d), 1e-6f);
}

TEST_F(HeadFileTest, RadiiAloneAreEnough) {
  const HeadGeometry head = LoadHeadFile(Write("radii_mm: " + Numbers(642, "95") + "\n"));
  EXPECT_NEAR(head.surface.Radius({0, 0, 1}), 0.095f, 1e-6f);
  EXPECT_NEAR(
      head.surface.HairSide({0, 0.1f, 0}),
      HeadSurface(HeadShape{}, {std::vector<float>(642, 0.095f), {}, {}}).HairSide({0, 0.1f, 0}),
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

TEST_F(HeadFileTest, AnEnrolledFaceIsReadBackToAThousandth) {
  const HeadSurface& adult = TheAdult().surface;
  HeadGeometry head{HeadSurface(HeadShape{}, TableOf(adult, 4)), {0, 0, 0}};
  LearnedFace face;
  Random random(4);
  for (const Eigen::Vector3f& p : SharedAdultHead().face.points) {
    face.points.push_back(head.surface.Onto(p));
    for (auto& value : face.value) value.push_back(static_cast<float>(20 * random.Normal()));
  }
  head.face = face;
  SaveHeadFile(name_, head);
  const HeadGeometry read = LoadHeadFile(name_);
  ASSERT_TRUE(read.face);
  ASSERT_EQ(read.face->points.size(), face.points.size());
  for (std::size_t i = 0; i < face.points.size(); ++i) {
    EXPECT_LT((read.face->points[i] - face.points[i]).norm(), 1.2e-6f);
    EXPECT_GT(read.face->normals[i].dot(head.surface.NormalAt(face.points[i])), 0.9999f);
    for (const Band band : {kFineBand, kCoarseBand})
      EXPECT_NEAR(read.face->value[band][i], face.value[band][i], 0.00051f);
  }
}

TEST_F(HeadFileTest, WhatCouldNotBeReadBackIsNotWritten) {
  HeadGeometry good;
  LearnedFace face;
  face.points.assign(100, {0, 0.02f, -0.08f});
  for (auto& value : face.value) value.assign(100, 1);
  good.face = face;
  SaveHeadFile(name_, good);
  EXPECT_EQ(LoadHeadFile(name_).face->points.size(), 100u);
  const auto expect_refusal = [&](const HeadGeometry& head, const char* key, const char* rule) {
    EXPECT_THAT([&] { SaveHeadFile(name_, head); },
                ::testing::ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr("head.yaml: is not written"), HasSubstr(key), HasSubstr(rule))))
        << key;
    EXPECT_NO_THROW(LoadHeadFile(name_)) << key;  // the earlier one is still there
  };
  HeadGeometry bad = good;
  bad.face->points.pop_back();
  for (auto& value : bad.face->value) value.pop_back();
  expect_refusal(bad, "face_points_mm", "100 to 5000 points");
  bad = good;
  bad.face->value[kFineBand][7] = 255.5f;
  expect_refusal(bad, "face_fine", "-255 to 255");
  bad = good;
  bad.face->value[kCoarseBand][99] = std::nanf("");
  expect_refusal(bad, "face_coarse", "-255 to 255");
  bad = good;
  bad.p_MR_m.x() = 1.1;
  expect_refusal(bad, "origin_mm", "-1000 to 1000 mm");
  HeadShape shape;
  shape.eye_x = 0.07f;
  bad = good;
  bad.surface = HeadSurface(shape, TableOf(TheAdult().surface, 4));
  expect_refusal(bad, "eye_x_mm", "10 to 60 mm");
}

TEST_F(HeadFileTest, AHeadWithoutAFaceIsReadBackWithoutOne) {
  SaveHeadFile(name_, HeadGeometry{});
  EXPECT_FALSE(LoadHeadFile(name_).face);
}

TEST(HeadFileFaceTest, EachPartOfAFaceThatIsWrongIsRefusedWithKeyValueAndRule) {
  HeadFile good;
  good.radii_mm.assign(642, 95);
  good.face_points_mm.assign(300, 50);
  good.face_fine.assign(100, 1);
  good.face_coarse.assign(100, -1);
  EXPECT_NO_THROW(good.ValidateOrThrow());
  const auto expect_refusal = [&](const auto& spoil, const std::string& key,
                                  const std::string& value, const std::string& rule) {
    HeadFile bad = good;
    spoil(&bad);
    ExpectRefusal([&] { bad.ValidateOrThrow(); }, key, value, rule);
  };
  const double nan = std::nan("");
  for (const std::size_t size : {299, 301, 297, 3, 1, 15003}) {
    expect_refusal([&](HeadFile* f) { f->face_points_mm.resize(size, 50); }, "face_points_mm",
                   std::to_string(size) + " numbers", "x y z of 100 to 5000 points");
  }
  for (const auto& [x, text] :
       {std::pair(400.1, "400.1"), {-400.1, "-400.1"}, {nan, "nan"}, {INFINITY, "inf"}}) {
    expect_refusal([&, x = x](HeadFile* f) { f->face_points_mm[299] = x; }, "face_points_mm", text,
                   "-400 to 400 mm");
  }
  for (const auto& [key, values] : {std::pair("face_fine", &HeadFile::face_fine),
                                    std::pair("face_coarse", &HeadFile::face_coarse)}) {
    for (const std::size_t size : {0, 99, 101}) {
      expect_refusal([&, values = values](HeadFile* f) { (f->*values).resize(size); }, key,
                     std::to_string(size) + " numbers", "one for each point of face_points_mm");
    }
    for (const auto& [x, text] : {std::pair(255.1, "255.1"), {-255.1, "-255.1"}, {nan, "nan"}}) {
      expect_refusal([&, x = x, values = values](HeadFile* f) { (f->*values)[99] = x; }, key, text,
                     "-255 to 255");
    }
  }
  // Brightness of a face that is not there.
  expect_refusal([](HeadFile* f) { f->face_points_mm.clear(); }, "face_fine", "100 numbers",
                 "one for each point");
}

}  // namespace
}  // namespace visavis
