#include "services/recogniser/refined/looks_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/random.h"
#include "tests/support/malloc_counter.h"
#include "tests/support/mesh_scene.h"

namespace visavis {
namespace {

const FacePoints& Face() { return SharedAdultHead().face; }

class LooksFitTest : public ::testing::Test {
 protected:
  /// gain (mean + modes a) + offset and noise, seen everywhere.
  FaceSamples Seen(double gain, double offset, double noise, const std::vector<float>& a = {}) {
    FaceSamples samples(Face().size());
    for (std::size_t i = 0; i < Face().size(); ++i) {
      float pattern = Face().generic[kFineBand][i];
      for (std::size_t k = 0; k < a.size(); ++k) pattern += a[k] * Face().modes[i][k];
      samples.value[i] = static_cast<float>(gain * static_cast<double>(pattern) + offset +
                                            noise * random_.Normal());
      samples.facing[i] = 1;
      const auto slope = [&] { return static_cast<float>(1000 * random_.Normal()); };
      samples.slope[i] = {slope(), slope(), slope()};
      samples.seen[i] = 1;
    }
    return samples;
  }

  Random random_{7};
  LooksFit fit_{Face()};
};

TEST_F(LooksFitTest, TheMeanFaceIsAFaceInAnyLight) {
  for (const double gain : {8.0, 30.0}) {
    const FaceSamples right = Seen(gain, 0, 0), left = Seen(0.5 * gain, 9, 0);
    EXPECT_GT(fit_.Fit({&right, &left}), 0.9) << gain;
  }
}

TEST_F(LooksFitTest, WhatFacesDifferInIsExplained) {
  const std::vector<float> a = {1.2f, -1, 0.8f, 0, -1.5f, 0.5f};
  const FaceSamples right = Seen(12, 3, 0.5, a), left = Seen(9, -2, 0.5, a);
  EXPECT_GT(fit_.Fit({&right, &left}), 0.6);
}

TEST_F(LooksFitTest, OneEyeIsEnough) {
  const FaceSamples one = Seen(12, 3, 0.2);
  EXPECT_GT(fit_.Fit({&one, nullptr}), 0.85);
  EXPECT_GT(fit_.Fit({nullptr, &one}), 0.85);
}

TEST_F(LooksFitTest, WhatIsNoFaceIsNotLikeOne) {
  const FaceSamples noise = Seen(0, 0, 10), other_noise = Seen(0, 0, 10);
  EXPECT_LT(fit_.Fit({&noise, &other_noise}), 0.1);
  const FaceSamples inverted = Seen(-12, 0, 0.5);
  EXPECT_LT(fit_.Fit({&inverted, &inverted}), 0.1);
  const FaceSamples flat = Seen(0, 5, 0);
  EXPECT_LT(fit_.Fit({&flat, &flat}), 0.1);
}

TEST_F(LooksFitTest, WhatOneEyeAloneSeesIsNoFace) {
  const FaceSamples face = Seen(12, 3, 0.2);
  for (const double noise : {0.0, 1.0, 10.0}) {
    const FaceSamples wall = Seen(0, 90, noise);
    EXPECT_LT(fit_.Fit({&face, &wall}), 0.2) << noise;
    EXPECT_LT(fit_.Fit({&wall, &face}), 0.2) << noise;
  }
}

TEST_F(LooksFitTest, WhereTooLittleIsSeenNothingIsSaid) {
  FaceSamples few = Seen(12, 0, 0);
  for (std::size_t i = 30; i < few.seen.size(); ++i) few.seen[i] = 0;
  PoseEquations equations;
  for (const std::array<const FaceSamples*, 2>& samples :
       {std::array<const FaceSamples*, 2>{&few, nullptr}, {&few, &few}, {nullptr, nullptr}}) {
    EXPECT_EQ(fit_.Fit(samples), 0);
    fit_.AddTo(samples, Eigen::Matrix3f::Identity(), 1, &equations);
  }
  EXPECT_LT(equations.H.norm(), 1e-6);
  EXPECT_LT(equations.g.norm(), 1e-6);
}

// The equations are of a pose [dp; w]: they lead back from one that is off.
TEST_F(LooksFitTest, APoseThatIsOffIsCorrectedWhoeverItIs) {
  Vector6d off;
  off << 0.001, -0.002, 0.0015, 0.01, 0.006, -0.012;
  const Eigen::Matrix3f R_CM = Eigen::Matrix3f::Identity();
  for (const std::vector<float>& a : {std::vector<float>{}, {0.6f, -0.5f, 0.4f}}) {
    std::array<FaceSamples, 2> eyes = {Seen(12, 3, 0.1, a), Seen(9, -2, 0.1, a)};
    for (FaceSamples& eye : eyes) {
      for (std::size_t i = 0; i < Face().size(); ++i) {
        const Eigen::Vector3f& p = Face().points[i];
        const Eigen::Vector3f moved =
            off.head<3>().cast<float>() + off.tail<3>().cast<float>().cross(p);
        eye.value[i] += eye.slope[i].dot(moved);
      }
    }
    fit_.Fit({&eyes[0], &eyes[1]});
    PoseEquations equations;
    fit_.AddTo({&eyes[0], &eyes[1]}, R_CM, 1, &equations);
    const Vector6d step = equations.Full().ldlt().solve(equations.g);
    // value = pattern + slope . off: seen where the head is not yet, so the step is the way back.
    EXPECT_LT((step - -off).head<3>().norm(), 0.0006);
    EXPECT_LT((step - -off).tail<3>().norm(), 0.006);
  }
}

TEST_F(LooksFitTest, FittingAllocatesNothing) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  const FaceSamples right = Seen(12, 0, 1), left = Seen(9, 0, 1);
  PoseEquations equations;
  const std::int64_t before = NumMallocs();
  fit_.Fit({&right, &left});
  fit_.AddTo({&right, &left}, Eigen::Matrix3f::Identity(), 1, &equations);
  EXPECT_EQ(NumMallocs(), before);
}

}  // namespace
}  // namespace visavis
