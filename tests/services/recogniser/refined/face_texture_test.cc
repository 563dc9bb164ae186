#include "services/recogniser/refined/face_texture.h"

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "tests/support/malloc_counter.h"
#include "tests/support/mesh_scene.h"

namespace visavis {
namespace {

const FacePoints& Face() { return SharedAdultHead().face; }

std::vector<float> RandomValues(std::uint64_t seed, double size = 10) {
  Random random(seed);
  std::vector<float> values(Face().size());
  for (float& v : values) v = static_cast<float>(size * random.Normal());
  return values;
}

FaceSamples SamplesOf(std::vector<float> values, float gain = 1, float offset = 0) {
  FaceSamples samples(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    samples.value[i] = gain * values[i] + offset;
    samples.seen[i] = 1;
  }
  return samples;
}

double LargestDifference(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a[i] - b[i])));
  return largest;
}

TEST(FaceTextureTest, BeginsWithTheGenericPointsAndKnowsNothing) {
  const FaceTexture texture(Face());
  EXPECT_FALSE(texture.learned());
  EXPECT_EQ(texture.points().points, Face().points);
  for (const unsigned char known : texture.known(kFineBand)) EXPECT_FALSE(known);
}

TEST(FaceTextureTest, TheFirstSightIsTakenAsItIs) {
  for (const Band band : {kFineBand, kCoarseBand}) {
    FaceTexture texture(Face());
    const std::vector<float> face = RandomValues(1);
    texture.Learn(band, SamplesOf(face));
    EXPECT_TRUE(texture.learned());
    EXPECT_LT(LargestDifference(texture.pattern(band), face), 1e-5);
  }
}

// Both bands of a pair are learned one after the other: neither counts as a sight of the other.
TEST(FaceTextureTest, EachBandKeepsTheUnitsOfItsOwnFirstPicture) {
  FaceTexture texture(Face());
  const std::vector<float> fine = RandomValues(1), coarse = RandomValues(2, 25);
  texture.Learn(kFineBand, SamplesOf(fine));
  texture.Learn(kCoarseBand, SamplesOf(coarse));
  EXPECT_LT(LargestDifference(texture.pattern(kFineBand), fine), 1e-4);
  EXPECT_LT(LargestDifference(texture.pattern(kCoarseBand), coarse), 1e-4);
}

TEST(FaceTextureTest, LearnsTheMean) {
  FaceTexture texture(Face());
  const std::vector<float> face = RandomValues(1);
  constexpr int kSights = 60;
  for (int k = 0; k < kSights; ++k) {
    std::vector<float> noisy = RandomValues(100 + static_cast<std::uint64_t>(k), 4);
    for (std::size_t i = 0; i < face.size(); ++i) noisy[i] += face[i];
    texture.Learn(kFineBand, SamplesOf(noisy));
  }
  const GainOffset fit =
      FitPattern(SamplesOf(face), texture.pattern(kFineBand), texture.known(kFineBand));
  // One sight correlates with 10 / sqrt(10^2 + 4^2) = 0.93, the mean of sixty nearly wholly.
  EXPECT_GT(fit.correlation, 0.995);
}

TEST(FaceTextureTest, GainAndOffsetOfLaterPicturesDoNotMatter) {
  FaceTexture texture(Face());
  const std::vector<float> face = RandomValues(1);
  texture.Learn(kFineBand, SamplesOf(face));
  for (const auto& [gain, offset] : {std::pair(2.0f, -30.0f), {0.5f, 20.0f}, {1.0f, 100.0f}}) {
    texture.Learn(kFineBand, SamplesOf(face, gain, offset));
    EXPECT_LT(LargestDifference(texture.pattern(kFineBand), face), 1e-3) << gain;
  }
}

TEST(FaceTextureTest, LaterSightsCountLessAndLess) {
  FaceTexture texture(Face());
  const std::vector<float> face = RandomValues(1);
  std::vector<float> changed = face;
  changed[5] += 30;
  std::vector<double> shifts;
  for (int k = 0; k < 4; ++k) {
    FaceTexture copy(Face());
    for (int i = 0; i <= 4 * k; ++i) copy.Learn(kFineBand, SamplesOf(face));
    copy.Learn(kFineBand, SamplesOf(changed));
    shifts.push_back(static_cast<double>(copy.pattern(kFineBand)[5] - face[5]));
  }
  EXPECT_NEAR(shifts[0], 15, 1.0);
  for (std::size_t k = 1; k < shifts.size(); ++k) EXPECT_LT(shifts[k], 0.8 * shifts[k - 1]);
  EXPECT_GT(shifts.back(), 0.2);  // never frozen
}

TEST(FaceTextureTest, ANewFaceReplacesTheOldOneInTheEnd) {
  FaceTexture texture(Face());
  for (int i = 0; i < 200; ++i) texture.Learn(kFineBand, SamplesOf(RandomValues(1)));
  std::vector<float> mixed = RandomValues(1);
  const std::vector<float> other = RandomValues(2);
  for (std::size_t i = 0; i < mixed.size() / 4; ++i) mixed[i] = other[i];  // a grown beard, say
  for (int i = 0; i < 1000; ++i) texture.Learn(kFineBand, SamplesOf(mixed));
  const GainOffset fit =
      FitPattern(SamplesOf(mixed), texture.pattern(kFineBand), texture.known(kFineBand));
  EXPECT_GT(fit.correlation, 0.98);
}

TEST(FaceTextureTest, PointsNotSeenStayUnknown) {
  FaceTexture texture(Face());
  FaceSamples half = SamplesOf(RandomValues(1));
  for (std::size_t i = 0; i < Face().size(); i += 2) half.seen[i] = 0;
  texture.Learn(kFineBand, half);
  for (std::size_t i = 0; i < Face().size(); ++i)
    EXPECT_EQ(texture.known(kFineBand)[i] != 0, i % 2 == 1);
}

TEST(FaceTextureTest, APointSeenInOneBandAloneIsKnownThereAndNotLearned) {
  FaceTexture texture(Face());
  texture.Learn(kFineBand, SamplesOf(RandomValues(1)));
  FaceSamples half = SamplesOf(RandomValues(1));
  for (std::size_t i = 0; i < Face().size(); i += 2) half.seen[i] = 0;
  texture.Learn(kCoarseBand, half);
  for (std::size_t i = 0; i < Face().size(); ++i) {
    EXPECT_TRUE(texture.known(kFineBand)[i]);
    EXPECT_EQ(texture.known(kCoarseBand)[i] != 0, i % 2 == 1);
  }
  // Points without a value would spoil the agreement of those with one.
  const FaceSamples all = SamplesOf(RandomValues(1));
  const auto& pattern = texture.pattern(kCoarseBand);
  EXPECT_GT(FitPattern(all, pattern, texture.known(kCoarseBand)).correlation, 0.999);
  EXPECT_LT(FitPattern(all, pattern, texture.known(kFineBand)).correlation, 0.9);
  EXPECT_EQ(texture.Learned().points.size(), Face().size() / 2);
}

TEST(FaceTextureTest, ForgettingAndRememberingAllocateNothingOnceDone) {
  if (NumMallocs() < 0) GTEST_SKIP() << "mallocs cannot be counted under a sanitizer";
  FaceTexture texture(Face());
  LearnedFace face;
  face.points.assign(2 * Face().size(), {0, 0, -0.08f});  // more than the generic one has
  face.normals.assign(face.points.size(), {0, 0, -1});
  for (auto& value : face.value) value.assign(face.points.size(), 1);
  const auto change = [&] {
    texture.Remember(face);
    EXPECT_EQ(texture.points().points.size(), face.points.size());
    texture.Forget();
    EXPECT_EQ(texture.points().points.size(), Face().size());
  };
  change();
  const std::int64_t before = NumMallocs();
  change();
  EXPECT_EQ(NumMallocs(), before);
}

TEST(FaceTextureTest, ASightOfTooFewKnownPointsIsLeftOut) {
  FaceTexture texture(Face());
  const std::vector<float> face = RandomValues(1);
  texture.Learn(kFineBand, SamplesOf(face));
  FaceSamples few = SamplesOf(RandomValues(2));
  std::fill(few.seen.begin() + 39, few.seen.end(), static_cast<unsigned char>(0));
  texture.Learn(kFineBand, few);
  EXPECT_LT(LargestDifference(texture.pattern(kFineBand), face), 1e-5);
}

TEST(FaceTextureTest, MoveMovesPointsRigidly) {
  FaceTexture texture(Face());
  const RigidTransform X_MN =
      MakeTransform(ExpRotation({0.1, -0.2, 0.05}), Eigen::Vector3d(0.003, -0.002, 0.004));
  texture.Move(X_MN);
  texture.Move(X_MN);
  const RigidTransform twice = X_MN * X_MN;
  for (std::size_t i = 0; i < Face().size(); ++i) {
    const Eigen::Vector3d p = twice * Face().points[i].cast<double>();
    const Eigen::Vector3d n = twice.linear() * Face().normals[i].cast<double>();
    EXPECT_LT((texture.points().points[i].cast<double>() - p).norm(), 1e-6);
    EXPECT_LT((texture.points().normals[i].cast<double>() - n).norm(), 1e-5);
  }
}

TEST(FaceTextureTest, ForgetGivesTheGenericPointsBackAndTheNextFaceIsTakenAsItIs) {
  FaceTexture texture(Face());
  for (const Band band : {kFineBand, kCoarseBand}) texture.Learn(band, SamplesOf(RandomValues(1)));
  texture.Move(MakeTransform(ExpRotation({0, 0.1, 0}), Eigen::Vector3d(0.01, 0, 0)));
  texture.Forget();
  EXPECT_FALSE(texture.learned());
  EXPECT_EQ(texture.points().points, Face().points);
  EXPECT_EQ(texture.points().normals, Face().normals);
  for (const unsigned char known : texture.known(kFineBand)) EXPECT_FALSE(known);
  const std::vector<float> other = RandomValues(2);
  for (const Band band : {kFineBand, kCoarseBand}) {
    texture.Learn(band, SamplesOf(other));
    EXPECT_LT(LargestDifference(texture.pattern(band), other), 1e-4);
  }
}

/// Every other point of the face, moved, with random brightness.
LearnedFace HalfAFace() {
  LearnedFace face;
  for (std::size_t i = 0; i < Face().size(); i += 2) {
    face.points.push_back(Face().points[i] + Eigen::Vector3f(0.001f, 0.002f, 0));
    face.normals.push_back(Face().normals[i]);
  }
  face.value = {RandomValues(1), RandomValues(2, 25)};
  for (auto& value : face.value) value.resize(face.points.size());
  return face;
}

TEST(FaceTextureTest, WhatWasLearnedHoldsThePointsSeenAndTheirBrightnessInBothBands) {
  FaceTexture texture(Face());
  EXPECT_TRUE(texture.Learned().points.empty());
  const std::vector<float> fine = RandomValues(1), coarse = RandomValues(2);
  FaceSamples samples = SamplesOf(fine);
  for (std::size_t i = 0; i < Face().size(); i += 2) samples.seen[i] = 0;
  texture.Learn(kFineBand, samples);
  samples.value = coarse;
  texture.Learn(kCoarseBand, samples);
  const LearnedFace face = texture.Learned();
  ASSERT_EQ(face.points.size(), Face().size() / 2);
  for (std::size_t i = 0; i < face.points.size(); ++i) {
    EXPECT_EQ(face.points[i], Face().points[2 * i + 1]);
    EXPECT_EQ(face.normals[i], Face().normals[2 * i + 1]);
    EXPECT_NEAR(face.value[kFineBand][i], fine[2 * i + 1], 1e-5);
    EXPECT_NEAR(face.value[kCoarseBand][i], coarse[2 * i + 1], 1e-5);
  }
  EXPECT_FALSE(texture.fixed());
}

TEST(FaceTextureTest, AFaceThatIsRememberedIsEnrolledAndGivenBackAsItWas) {
  const LearnedFace face = HalfAFace();
  FaceTexture texture(Face());
  texture.Learn(kFineBand, SamplesOf(RandomValues(3)));  // of somebody else: gone
  texture.Remember(face);
  EXPECT_TRUE(texture.fixed());
  EXPECT_TRUE(texture.learned());
  const LearnedFace again = texture.Learned();
  EXPECT_EQ(again.points, face.points);
  EXPECT_EQ(again.normals, face.normals);
  EXPECT_EQ(again.value, face.value);
}

TEST(FaceTextureTest, ARememberedFaceCountsAsLearnedForLong) {
  const LearnedFace face = HalfAFace();
  FaceTexture texture(Face());
  texture.Remember(face);
  std::vector<float> changed = face.value[kFineBand];
  changed[5] += 30;
  texture.Learn(kFineBand, SamplesOf(changed));
  const float shift = texture.pattern(kFineBand)[5] - face.value[kFineBand][5];
  EXPECT_GT(shift, 0.05f);
  EXPECT_LT(shift, 0.5f);
}

TEST(FaceTextureTest, ForgetEndsAnEnrolment) {
  FaceTexture texture(Face());
  texture.Remember(HalfAFace());
  texture.Forget();
  EXPECT_FALSE(texture.fixed());
  EXPECT_FALSE(texture.learned());
  EXPECT_EQ(texture.points().points, Face().points);
  EXPECT_EQ(texture.known(kFineBand).size(), Face().size());
  EXPECT_TRUE(texture.Learned().points.empty());
  const std::vector<float> other = RandomValues(4);
  texture.Learn(kFineBand, SamplesOf(other));
  EXPECT_LT(LargestDifference(texture.pattern(kFineBand), other), 1e-5);
}

}  // namespace
}  // namespace visavis
