// Eqs. 15 and 16 and the exact transform: individuals carried from one exposure to the next.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <vector>

#include "common/core/random.h"
#include "common/kinematics/feedforward.h"
#include "common/kinematics/hand_eye.h"
#include "tests/common/kinematics/test_arm.h"

namespace visavis {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kDegree = M_PI / 180;

Vector3d RandomVector(double size, Random* random) {
  return {random->Uniform(-size, size), random->Uniform(-size, size), random->Uniform(-size, size)};
}

RigidTransform RandomPose(Random* random) {
  return MakeTransform(RotationFromAngles(RandomVector(1.4, random)), RandomVector(1, random));
}

CameraTwist RandomTwist(Random* random) {
  return {RandomVector(0.5, random), RandomVector(0.5, random)};
}

/// Individuals all over the default search space.
Matrix6Xd RandomPopulation(int n, Random* random) {
  Matrix6Xd population(6, n);
  for (int i = 0; i < n; ++i) {
    population.col(i) << RandomVector(0.2, random) + Vector3d(0, 0, 1.05),
        RandomVector(20 * kDegree, random);
  }
  return population;
}

TEST(FeedforwardStepTest, TwistFormIsJmTimesJointVelocities) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const HandEye hand_eye(TestArm::Random(9, &random).Build(), RandomPose(&random),
                           RandomPose(&random));
    const Eigen::VectorXd q = RandomJoints(hand_eye.arm().num_joints(), &random);
    const Eigen::VectorXd qdot = RandomJoints(hand_eye.arm().num_joints(), &random);
    const Matrix3d R_WC = hand_eye.CameraPose(q).linear();
    const JacobianMatrix J = hand_eye.CameraJacobian(q);
    const Vector6d phi = RandomPopulation(1, &random);
    const Vector6d expected = CameraMotionJacobian(phi, R_WC, J) * qdot;  // Eq. 15
    EXPECT_LT((PhiRate(phi, R_WC, TwistFromJoints(J, qdot)) - expected).norm(),
              1e-13 * (1 + expected.norm()));
  }
}

TEST(FeedforwardStepTest, Eq16IsOneEulerStep) {
  Random random(2);
  const RigidTransform X_WC = RandomPose(&random);
  const CameraTwist camera = RandomTwist(&random);
  const Vector6d phi = RandomPopulation(1, &random);
  const Vector6d rate = PhiRate(phi, X_WC.linear(), camera);
  const Vector6d stepped = EulerStep(phi, X_WC.linear(), camera, 1.0 / 30);
  for (int k = 0; k < 6; ++k) EXPECT_DOUBLE_EQ(stepped[k], phi[k] + rate[k] / 30);
}

/// Largest error of a step over a population that is carried over a time @p dt.
double EulerError(double dt) {
  Random random(3);
  const RigidTransform X_WC1 = RandomPose(&random);
  const CameraTwist camera = RandomTwist(&random);
  const RigidTransform X_WC2 =
      MakeTransform(Matrix3d(ExpRotation(dt * camera.w_WC) * X_WC1.linear()),
                    X_WC1.translation() + dt * camera.v_WC);
  Matrix6Xd by_euler = RandomPopulation(60, &random), exact = by_euler;
  EulerStepAll(X_WC1.linear(), camera, dt, by_euler);
  CarryAll(CameraDisplacement(X_WC1, X_WC2), exact);
  return (by_euler - exact).cwiseAbs().maxCoeff();
}

TEST(FeedforwardStepTest, EulerStepErrsWithTheSquareOfTheTimeStep) {
  const double coarse = EulerError(0.02), fine = EulerError(0.002);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_NEAR(coarse / fine, 100, 10);
}

TEST(FeedforwardStepTest, CarriedHeadKeepsItsPlaceInTheWorld) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform X_WC1 = RandomPose(&random), X_WC2 = RandomPose(&random);
    const Vector6d phi_1 = RandomPopulation(1, &random);
    const Vector6d phi_2 = Carry(CameraDisplacement(X_WC1, X_WC2), phi_1);
    EXPECT_LT(MaxDifference(X_WC2 * TransformFromPhi(phi_2), X_WC1 * TransformFromPhi(phi_1)),
              1e-14 * 10);
  }
}

TEST(FeedforwardStepTest, CameraAtRestLeavesIndividualsWhereTheyAre) {
  Random random(5);
  const RigidTransform X_WC = RandomPose(&random);
  const Matrix6Xd before = RandomPopulation(60, &random);
  Matrix6Xd exact = before, euler = before;
  CarryAll(CameraDisplacement(X_WC, X_WC), exact);
  EulerStepAll(X_WC.linear(), CameraTwist{}, 1.0 / 30, euler);
  EXPECT_LT((exact - before).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_EQ(euler, before);
}

TEST(FeedforwardStepTest, BatchGivesTheNumbersOfTheSingleForms) {
  Random random(6);
  const RigidTransform X_WC1 = RandomPose(&random), X_WC2 = RandomPose(&random);
  const RigidTransform X_C2C1 = CameraDisplacement(X_WC1, X_WC2);
  const CameraTwist camera = RandomTwist(&random);
  const Matrix6Xd before = RandomPopulation(67, &random);
  Matrix6Xd exact = before, euler = before;
  CarryAll(X_C2C1, exact);
  EulerStepAll(X_WC1.linear(), camera, 0.03, euler);
  for (int i = 0; i < before.cols(); ++i) {
    EXPECT_EQ(exact.col(i), Carry(X_C2C1, before.col(i)));
    EXPECT_EQ(euler.col(i), EulerStep(before.col(i), X_WC1.linear(), camera, 0.03));
  }
}

TEST(FeedforwardStepTest, BatchWorksOnAnArrayOfSixes) {
  Random random(7);
  const Matrix6Xd before = RandomPopulation(3, &random);
  double individuals[3][6];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 6; ++k) individuals[i][k] = before(k, i);
  const RigidTransform X_C2C1 = RandomPose(&random);
  CarryAll(X_C2C1, Eigen::Map<Matrix6Xd>(&individuals[0][0], 6, 3));
  for (int i = 0; i < 3; ++i) {
    const Vector6d expected = Carry(X_C2C1, before.col(i));
    for (int k = 0; k < 6; ++k) EXPECT_EQ(individuals[i][k], expected[k]);
  }
}

TEST(FeedforwardStepTest, EulerStepRefusesThetaOf90DegreesAndChangesNoIndividual) {
  Random random(8);
  Matrix6Xd population = RandomPopulation(5, &random);
  population(4, 3) = -M_PI / 2;
  const Matrix6Xd before = population;
  const Matrix3d R_WC = RandomPose(&random).linear();
  const CameraTwist camera = RandomTwist(&random);
  EXPECT_THROW(EulerStep(before.col(3), R_WC, camera, 0.03), std::domain_error);
  EXPECT_THAT([&] { EulerStepAll(R_WC, camera, 0.03, population); },
              ThrowsMessage<std::domain_error>(
                  AllOf(HasSubstr("individual 3: theta = -1.57"), HasSubstr("must stay off"))));
  EXPECT_EQ(population, before);
}

TEST(FeedforwardStepTest, TwistBetweenTwoPosesIsThatOfASteadyMotion) {
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform X_WC1 = RandomPose(&random);
    const CameraTwist camera = RandomTwist(&random);
    const double dt = random.Uniform(0.001, 0.1);
    const RigidTransform X_WC2 =
        MakeTransform(Matrix3d(ExpRotation(dt * camera.w_WC) * X_WC1.linear()),
                      X_WC1.translation() + dt * camera.v_WC);
    const CameraTwist twist = TwistBetween(X_WC1, X_WC2, dt);
    EXPECT_LT((twist.v_WC - camera.v_WC).norm(), 1e-11);
    EXPECT_LT((twist.w_WC - camera.w_WC).norm(), 1e-11);
  }
  const RigidTransform X = RigidTransform::Identity();
  EXPECT_THAT([&] { TwistBetween(X, X, 0); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("dt_s = 0")));
}

// What an Euler step costs at the paper's motions and 30 frames a second: after one frame, for
// individuals all over the search space. Why `exact` is the default.
TEST(FeedforwardStepTest, EulerErrorPerFrameOfThePapersMotionsIsSmall) {
  const double dt = 1.0 / 30;
  Random random(10);
  const auto worst_of = [&](const auto& pose, double period_s) {
    double worst_mm = 0;
    for (double t = 0; t < period_s; t += dt) {
      const RigidTransform X_1 = pose(t), X_2 = pose(t + dt);
      const CameraTwist camera = TwistBetween(pose(t - 1e-5), pose(t + 1e-5), 2e-5);
      Matrix6Xd euler = RandomPopulation(20, &random), exact = euler;
      EulerStepAll(X_1.linear(), camera, dt, euler);
      CarryAll(CameraDisplacement(X_1, X_2), exact);
      const Matrix6Xd error = euler - exact;
      worst_mm = std::max(worst_mm, error.topRows<3>().colwise().norm().maxCoeff() * 1e3);
    }
    return worst_mm;
  };
  const auto shuttle = [](double period_s) {
    return [=](double t) {
      RigidTransform X = RigidTransform::Identity();
      X.translation().x() = 0.15 * std::cos(2 * M_PI * t / period_s);
      return X;
    };
  };
  const auto orbit = [](double period_s) {
    return [=](double t) {
      const double angle = 10 * kDegree * std::cos(2 * M_PI * t / period_s);
      const Matrix3d R = ExpRotation({0, angle, 0});
      return MakeTransform(R, Vector3d(0, 0, 1) - R * Vector3d(0, 0, 1));
    };
  };
  const double shuttle_7 = worst_of(shuttle(7), 7), orbit_10 = worst_of(orbit(10), 10),
               shuttle_1 = worst_of(shuttle(1), 1);
  std::printf(
      "Euler step, error a frame: shuttle T=7 s %.3f mm, orbit T=10 s %.3f mm, "
      "shuttle T=1 s %.2f mm\n",
      shuttle_7, orbit_10, shuttle_1);
  EXPECT_LT(shuttle_7, 0.1);
  EXPECT_LT(orbit_10, 0.1);
  // 1/2 dt^2 of the acceleration, 0.15 (2 pi)^2 m/s^2.
  EXPECT_NEAR(shuttle_1, 0.5 * dt * dt * 0.15 * 39.478 * 1e3, 0.1);
}

TEST(FeedforwardStepTest, PrintsItsCostForSixtyIndividuals) {
  Random random(11);
  const RigidTransform X_WC = RandomPose(&random);
  const RigidTransform X_C2C1 = CameraDisplacement(X_WC, X_WC);
  const CameraTwist camera = RandomTwist(&random);
  Matrix6Xd population = RandomPopulation(60, &random);
  const auto us_of = [&](const auto& step) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 1000; ++i) step();
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
               .count() /
           1000;
  };
  const double exact_us = us_of([&] { CarryAll(X_C2C1, population); });
  const double euler_us = us_of([&] { EulerStepAll(X_WC.linear(), camera, 1e-6, population); });
  std::printf("60 individuals: exact %.1f us, jacobian %.1f us\n", exact_us, euler_us);
  EXPECT_TRUE(population.allFinite());
}

}  // namespace
}  // namespace visavis
