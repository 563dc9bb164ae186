// Eqs. 1 to 8 and 14: each against finite differences of what it claims, and against a twin that
// spells the printed formula out, number by number.

#include "common/kinematics/feedforward.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/core/random.h"
#include "common/kinematics/hand_eye.h"
#include "tests/common/kinematics/test_arm.h"

namespace visavis {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kStep = 1e-6;  // [s] of central differences

/// A frame that moves in W at constant linear and angular velocity.
struct MovingFrame {
  RigidTransform X;  // at time 0
  Vector3d v, w;     // in W

  RigidTransform At(double t) const {
    return MakeTransform(Matrix3d(ExpRotation(t * w) * X.linear()), X.translation() + t * v);
  }
  CameraTwist twist() const { return {v, w}; }
};

Vector3d RandomVector(double size, Random* random) {
  return {random->Uniform(-size, size), random->Uniform(-size, size), random->Uniform(-size, size)};
}

MovingFrame RandomFrame(Random* random) {
  return {MakeTransform(RotationFromAngles(RandomVector(1.4, random)), RandomVector(1, random)),
          RandomVector(1, random), RandomVector(1, random)};
}

Vector3d FromCross(const Matrix3d& m) { return {m(2, 1), m(0, 2), m(1, 0)}; }

/// Camera and head, both moving, the head about 1 m in front and turned by up to +-60 deg.
struct Scene {
  explicit Scene(Random* random) : camera(RandomFrame(random)), head(RandomFrame(random)) {
    phi << RandomVector(0.2, random) + Vector3d(0, 0, 1), RandomVector(1.05, random);
    head.X = camera.X * TransformFromPhi(phi);
  }
  RigidTransform X_CM(double t) const { return camera.At(t).inverse() * head.At(t); }
  /// d/dt of phi at time 0, by central differences.
  Vector6d PhiRateByDifferences() const {
    return (PhiFromTransform(X_CM(kStep)) - PhiFromTransform(X_CM(-kStep))) / (2 * kStep);
  }
  MovingFrame camera, head;
  Vector6d phi;  // of X_CM(0)
};

TEST(FeedforwardTest, Eq1IsThePositionOfTheHeadInTheCamera) {
  Random random(1);
  const Scene scene(&random);
  EXPECT_LT(
      (PositionInCamera(scene.camera.X, scene.head.X.translation()) - scene.phi.head<3>()).norm(),
      1e-14);
}

TEST(FeedforwardTest, Eq2IsTheDerivativeOfEq1) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Scene scene(&random);
    const auto p = [&](double t) {
      return PositionInCamera(scene.camera.At(t), scene.head.At(t).translation());
    };
    const Vector3d expected = (p(kStep) - p(-kStep)) / (2 * kStep);
    const Vector3d v = VelocityInCamera(scene.camera.X, scene.camera.twist(),
                                        scene.head.X.translation(), scene.head.v);
    EXPECT_LT((v - expected).norm(), 1e-8);
  }
}

TEST(FeedforwardTest, Eq3IsTheTurningOfTheHeadInTheCamera) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Scene scene(&random);
    const Matrix3d dR = (scene.X_CM(kStep).linear() - scene.X_CM(-kStep).linear()) / (2 * kStep);
    const Vector3d expected = FromCross(dR * scene.X_CM(0).linear().transpose());
    const Vector3d w =
        AngularVelocityInCamera(scene.camera.X.linear(), scene.camera.w, scene.head.w);
    EXPECT_LT((w - expected).norm(), 1e-8);
  }
}

TEST(FeedforwardTest, Eqs4And5TurnJointVelocitiesIntoTheCamerasTwist) {
  Random random(4);
  const HandEye hand_eye(TestArm::Random(9, &random).Build(), RandomFrame(&random).X,
                         RandomFrame(&random).X);
  const Eigen::VectorXd q = RandomJoints(hand_eye.arm().num_joints(), &random);
  const Eigen::VectorXd qdot = RandomJoints(hand_eye.arm().num_joints(), &random);
  const RigidTransform before = hand_eye.CameraPose(q - kStep * qdot),
                       after = hand_eye.CameraPose(q + kStep * qdot);
  const CameraTwist expected = TwistBetween(before, after, 2 * kStep);
  const CameraTwist twist = TwistFromJoints(hand_eye.CameraJacobian(q), qdot);
  EXPECT_LT((twist.v_WC - expected.v_WC).norm(), 1e-8);
  EXPECT_LT((twist.w_WC - expected.w_WC).norm(), 1e-8);
}

// Eqs. 12, 13: R_AB' = [w_AB x] R_AB, with w_AB of B in A expressed in A; R_BA' likewise.
// Eq. 14: [w_AB x] = -R_AB [w_BA x] R_BA.
TEST(FeedforwardTest, Eq14RelatesTheTwoAngularVelocities) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const MovingFrame b = RandomFrame(&random);
    const Matrix3d R_AB = b.X.linear(), R_BA = R_AB.transpose();
    const Matrix3d dR_AB = (b.At(kStep).linear() - b.At(-kStep).linear()) / (2 * kStep);
    const Matrix3d w_AB_cross = dR_AB * R_BA;              // Eq. 12
    const Matrix3d w_BA_cross = dR_AB.transpose() * R_AB;  // Eq. 13
    EXPECT_LT((w_AB_cross + R_AB * w_BA_cross * R_BA).norm(), 1e-8);
    EXPECT_LT((w_AB_cross - Skew(b.w)).norm(), 1e-8);
  }
}

TEST(FeedforwardTest, Eq6WithTheSignOfEq14IsTheTurningOfTheWorldInTheCamera) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const MovingFrame camera = RandomFrame(&random);
    const Matrix3d dR_CW = (camera.At(kStep).linear() - camera.At(-kStep).linear()).transpose();
    const Matrix3d expected = dR_CW / (2 * kStep) * camera.X.linear();
    EXPECT_LT((WorldRotationInCamera(camera.X.linear(), camera.w) - expected).norm(), 1e-8);
  }
}

// Eq. 6 as printed has no minus sign. Put into Eq. 2 it is wrong by 2 |w x p|: for a camera that
// turns at 1 rad/s, 1 m from the head, by 2 m/s.
TEST(FeedforwardTest, Eq6AsPrintedErrsByMetresASecond) {
  const MovingFrame camera{RigidTransform::Identity(), {0, 0, 0}, {0, 1, 0}};
  const Vector3d p_WM(0, 0, 1);
  const Matrix3d R_CW = camera.X.linear().transpose();
  const Matrix3d as_printed = R_CW * Skew(camera.w) * R_CW.transpose();
  const Vector3d truth =
      (PositionInCamera(camera.At(kStep), p_WM) - PositionInCamera(camera.At(-kStep), p_WM)) /
      (2 * kStep);
  EXPECT_LT((VelocityInCamera(camera.X, camera.twist(), p_WM, {0, 0, 0}) - truth).norm(), 1e-9);
  EXPECT_NEAR((as_printed * R_CW * p_WM - truth).norm(), 2.0, 1e-9);
}

/// An eye in a hand, at random joint positions and velocities, and a head.
struct EyeInHandScene {
  explicit EyeInHandScene(Random* random)
      : hand_eye(TestArm::Random(9, random).Build(), RandomFrame(random).X, RandomFrame(random).X),
        q(RandomJoints(hand_eye.arm().num_joints(), random)),
        qdot(RandomJoints(hand_eye.arm().num_joints(), random)),
        X_WC(hand_eye.CameraPose(q)),
        J(hand_eye.CameraJacobian(q)) {
    phi << RandomVector(0.2, random) + Vector3d(0, 0, 1), RandomVector(1.05, random);
  }
  HandEye hand_eye;
  Eigen::VectorXd q, qdot;
  RigidTransform X_WC;
  JacobianMatrix J;
  Vector6d phi;
};

TEST(FeedforwardTest, JmMatchesFiniteDifferencesOfAHeadAtRest) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const EyeInHandScene scene(&random);
    const RigidTransform X_WM = scene.X_WC * TransformFromPhi(scene.phi);
    const auto phi = [&](double t) {
      const Eigen::VectorXd q = scene.q + t * scene.qdot;
      return PhiFromTransform(scene.hand_eye.CameraPose(q).inverse() * X_WM);
    };
    const Vector6d expected = (phi(kStep) - phi(-kStep)) / (2 * kStep);
    const Vector6d rate =
        CameraMotionJacobian(scene.phi, scene.X_WC.linear(), scene.J) * scene.qdot;
    EXPECT_LT((rate - expected).norm(), 2e-7);
  }
}

/// Eq. 8's J_m, joint by joint, with plain arrays and Cramer's rule for J_c^-1.
void JmTwin(const double phi[6], const double R[3][3], const double J[6], double Jm[6]) {
  double Rp[3] = {}, Jo_C[3] = {}, Rp_x_Jo[3] = {};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) Rp[r] += R[r][c] * phi[c];
  for (int r = 0; r < 3; ++r) {
    const int a = (r + 1) % 3, b = (r + 2) % 3;
    Rp_x_Jo[r] = Rp[a] * J[3 + b] - Rp[b] * J[3 + a];
  }
  for (int r = 0; r < 3; ++r) {
    Jm[r] = 0;
    for (int c = 0; c < 3; ++c) Jm[r] += R[c][r] * (-J[c] + Rp_x_Jo[c]);
    for (int c = 0; c < 3; ++c) Jo_C[r] += R[c][r] * J[3 + c];
  }
  const double cz = std::cos(phi[3]), sz = std::sin(phi[3]);
  const double cy = std::cos(phi[4]), sy = std::sin(phi[4]);
  const double Jc[3][3] = {{0, -sz, cz * cy}, {0, cz, sz * cy}, {1, 0, -sy}};
  const auto determinant = [](const double m[3][3]) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  for (int k = 0; k < 3; ++k) {
    double m[3][3];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) m[r][c] = c == k ? Jo_C[r] : Jc[r][c];
    Jm[3 + k] = -determinant(m) / determinant(Jc);
  }
}

TEST(FeedforwardTest, JmIsItsNaiveTwin) {
  Random random(8);
  for (int i = 0; i < 100; ++i) {
    const EyeInHandScene scene(&random);
    double R[3][3];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) R[r][c] = scene.X_WC.linear()(r, c);
    const JacobianMatrix Jm = CameraMotionJacobian(scene.phi, scene.X_WC.linear(), scene.J);
    for (int k = 0; k < scene.J.cols(); ++k) {
      Vector6d expected;
      JmTwin(scene.phi.data(), R, Vector6d(scene.J.col(k)).data(), expected.data());
      EXPECT_LT((Jm.col(k) - expected).norm(), 1e-13 * (1 + expected.norm()));
    }
  }
}

// Eq. 8 whole: J_m qdot + J_n [v_WM; w_WM] when both move. J_m takes the camera's twist as if it
// were six joints with J = I.
TEST(FeedforwardTest, Eq8IsTheRateOfPhiWhenCameraAndHeadMove) {
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    const Scene scene(&random);
    const Matrix3d R_WC = scene.camera.X.linear();
    Vector6d camera, head;
    camera << scene.camera.v, scene.camera.w;
    head << scene.head.v, scene.head.w;
    const JacobianMatrix J = Eigen::Matrix<double, 6, 6>::Identity();
    const Vector6d rate = CameraMotionJacobian(scene.phi, R_WC, J) * camera +
                          HeadMotionJacobian(scene.phi, R_WC) * head;
    EXPECT_LT((rate - scene.PhiRateByDifferences()).norm(), 1e-7);
  }
}

TEST(FeedforwardTest, JnMatchesFiniteDifferencesOfACameraAtRest) {
  Random random(10);
  for (int i = 0; i < 100; ++i) {
    Scene scene(&random);
    scene.camera.v = scene.camera.w = Vector3d::Zero();
    Vector6d head;
    head << scene.head.v, scene.head.w;
    const Vector6d rate = HeadMotionJacobian(scene.phi, scene.camera.X.linear()) * head;
    EXPECT_LT((rate - scene.PhiRateByDifferences()).norm(), 1e-7);
  }
}

TEST(FeedforwardTest, JmAndJnRefuseThetaOf90Degrees) {
  Random random(11);
  EyeInHandScene scene(&random);
  const Matrix3d R_WC = scene.X_WC.linear();
  for (const double theta : {M_PI / 2, -M_PI / 2}) {
    scene.phi[4] = theta;
    EXPECT_THAT([&] { CameraMotionJacobian(scene.phi, R_WC, scene.J); },
                ThrowsMessage<std::domain_error>(HasSubstr("theta = ")));
    EXPECT_THROW(HeadMotionJacobian(scene.phi, R_WC), std::domain_error);
  }
}

}  // namespace
}  // namespace visavis
