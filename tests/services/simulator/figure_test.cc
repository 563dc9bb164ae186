#include "services/simulator/figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr FigureDetail kCoarse{56, 44, 256};

std::set<Label> LabelsOf(const std::vector<Part>& parts) {
  std::set<Label> labels;
  for (const Part& part : parts) {
    for (int y = 0; y < part.texture.height(); ++y) {
      for (int x = 0; x < part.texture.width(); ++x) labels.insert(part.texture.at(x, y).label);
    }
  }
  return labels;
}

class FigureTest : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Subjects, FigureTest, ::testing::ValuesIn(SubjectNames()));

TEST_P(FigureTest, IsSoundAndHasAllFeatures) {
  const Subject subject = NamedSubject(GetParam());
  const Figure figure = BuildFigure(subject, kCoarse);
  for (const auto* parts : {&figure.head, &figure.body}) {
    for (const Part& part : *parts) {
      part.mesh.ValidateOrThrow();
      for (const Eigen::Vector3f& normal : part.mesh.normals) ASSERT_NEAR(normal.norm(), 1, 1e-4);
    }
  }
  std::set<Label> expected{Label::kSkin, Label::kNeck, Label::kEye,     Label::kBrow,
                           Label::kLash, Label::kLips, Label::kNostril, Label::kEar};
  if (subject.hair.kind != HairStyle::Kind::kBald) expected.insert(Label::kHair);
  EXPECT_EQ(LabelsOf(figure.head), expected);
  EXPECT_EQ(LabelsOf(figure.body), std::set<Label>{Label::kClothes});
  // The eyes: mirror images, the pupils' distance apart, on the front of the face.
  const Eigen::Vector3d right = figure.p_M_eye_right_m, left = figure.p_M_eye_left_m;
  EXPECT_NEAR(1e3 * (right - left).x(), subject.shape.interpupillary_mm, 2.5);
  EXPECT_NEAR(1e3 * (right + left).x(), 0, 1);
  EXPECT_NEAR(right.y(), left.y(), 1e-3);
  EXPECT_NEAR(1e3 * right.y(), 22 * subject.shape.height_mm / 228, 3);
  EXPECT_LT(right.z(), -0.06);
}

TEST(FigureTest, OnlyTheNeckBends) {
  const Figure figure = BuildFigure(NamedSubject("adult_a"), kCoarse);
  const Mesh& head = figure.head.front().mesh;
  for (std::size_t k = 0; k < head.vertices.size(); ++k) {
    const float y = head.vertices[k].y(), weight = head.head_weight[k];
    EXPECT_TRUE(y > 0.12f || weight == 1) << y << ' ' << weight;
    EXPECT_TRUE(y < 0.22f || weight == 0) << y << ' ' << weight;
  }
}

TEST(FigureTest, SameSubjectSameTexels) {
  const Figure a = BuildFigure(NamedSubject("adult_g"), {24, 20, 64});
  const Figure b = BuildFigure(NamedSubject("adult_g"), {24, 20, 64});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(a.head[0].texture.at(x, y).red, b.head[0].texture.at(x, y).red);
      ASSERT_EQ(a.head[0].texture.at(x, y).dx, b.head[0].texture.at(x, y).dx);
    }
  }
}

TEST(SubjectTest, AtLeastSixDifferInShapeSkinAndHair) {
  std::set<double> heights, skins, hairs;
  for (const std::string& name : SubjectNames()) {
    const Subject subject = NamedSubject(name);
    subject.ValidateOrThrow();
    heights.insert(subject.shape.height_mm);
    skins.insert(subject.complexion.skin.mean());
    hairs.insert(subject.hair.colour.mean());
  }
  EXPECT_GE(SubjectNames().size(), 6u);
  EXPECT_GE(heights.size(), 6u);
  EXPECT_GE(skins.size(), 6u);
  EXPECT_GE(hairs.size(), 6u);
  EXPECT_LT(*skins.begin(), 0.3);    // from very dark
  EXPECT_GT(*skins.rbegin(), 0.75);  // to very light
}

TEST(SubjectTest, AnUnknownNameIsRefusedWithTheKnownOnes) {
  EXPECT_THAT([] { NamedSubject("adult_z"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("adult_z: must be one of adult_a, ")));
}

TEST(SubjectTest, RefusesAColourBeyondItsRange) {
  Subject subject = NamedSubject("adult_a");
  subject.complexion.skin.x() = 1.2;
  EXPECT_THROW(subject.ValidateOrThrow(), std::invalid_argument);
}

TEST(HandTest, IsAHandsSizeAndLabelledSo) {
  const std::vector<Part> hand = BuildHand(Srgb(0.7, 0.5, 0.4));
  Eigen::Vector3f low = Eigen::Vector3f::Constant(9), high = -low;
  for (const Part& part : hand) {
    part.mesh.ValidateOrThrow();
    for (const Eigen::Vector3f& p : part.mesh.vertices) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  EXPECT_NEAR(low.y(), -0.145f, 0.02f);
  EXPECT_LT(high.z() - low.z(), 0.08f);
  EXPECT_EQ(LabelsOf(hand), std::set<Label>{Label::kHand});
}

}  // namespace
}  // namespace visavis
