#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "common/core/random.h"
#include "common/geometry/head_angles.h"
#include "common/kinematics/arm.h"

namespace visavis {

/// A serial arm described apart from the code under test, and its kinematics as a product of
/// exponentials: X_BH = exp([S_1] q_1) ... exp([S_n] q_n) X_BH(0), S_i the screw of joint i in B.
struct TestArm {
  struct Joint {
    std::string type;  // of the URDF
    Eigen::Vector3d xyz, rpy, axis;
  };
  std::vector<Joint> joints;

  /// Any kinds of joints, anywhere, axes of any length.
  static TestArm Random(int num_joints, ::visavis::Random* random) {
    const char* const types[] = {"revolute", "continuous", "prismatic", "fixed"};
    const auto vector = [&](double size) {
      return Eigen::Vector3d(random->Uniform(-size, size), random->Uniform(-size, size),
                             random->Uniform(-size, size));
    };
    TestArm arm;
    for (int i = 0; i < num_joints; ++i) {
      arm.joints.push_back({types[i == 0 ? 0 : random->Index(4)], vector(0.5), vector(3),
                            vector(1) + Eigen::Vector3d(0, 0, 1.5)});
    }
    return arm;
  }

  /// Links l0 (the base) to ln (the tip), joints j1 to jn.
  std::string Urdf() const {
    std::ostringstream xml;
    xml.precision(17);
    xml << "<robot name='test'><link name='l0'/>";
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const Joint& j = joints[i];
      xml << "<link name='l" << i + 1 << "'/><joint name='j" << i + 1 << "' type='" << j.type
          << "'><parent link='l" << i << "'/><child link='l" << i + 1 << "'/><origin xyz='"
          << j.xyz.transpose() << "' rpy='" << j.rpy.transpose() << "'/><axis xyz='"
          << j.axis.transpose()
          << "'/><limit lower='-3' upper='2' velocity='1.5' effort='1'/></joint>";
    }
    xml << "</robot>";
    return xml.str();
  }
  Arm Build() const { return Arm(Urdf(), "l0", "l" + std::to_string(joints.size())); }

  struct Screw {
    Eigen::Vector3d v, w;
  };
  struct Screws {
    std::vector<Screw> moving;
    RigidTransform home;  // X_BH at q = 0
  };
  Screws ToScrews() const {
    Screws screws{{}, RigidTransform::Identity()};
    for (const Joint& j : joints) {
      // The URDF's rpy is Rz(yaw) Ry(pitch) Rx(roll).
      screws.home =
          screws.home * MakeTransform(RotationFromAngles({j.rpy[2], j.rpy[1], j.rpy[0]}), j.xyz);
      const Eigen::Vector3d axis = screws.home.linear() * j.axis.normalized();
      if (j.type == "prismatic") screws.moving.push_back({axis, Eigen::Vector3d::Zero()});
      if (j.type == "revolute" || j.type == "continuous") {
        screws.moving.push_back({-axis.cross(screws.home.translation()), axis});
      }
    }
    return screws;
  }

  static RigidTransform Exp(const Screw& s, double q) {
    if (s.w.isZero()) return MakeTransform(Eigen::Matrix3d::Identity().eval(), s.v * q);
    const Eigen::Matrix3d R = ExpRotation(s.w * q);
    return MakeTransform(
        R, (Eigen::Matrix3d::Identity() - R) * s.w.cross(s.v) + s.w * s.w.dot(s.v) * q);
  }

  /// Joint i's screw carried by the joints before it is column i: [velocity of P; w] in B.
  struct Kinematics {
    RigidTransform X_BH;
    Eigen::MatrixXd J;
  };
  Kinematics Compute(const Eigen::VectorXd& q, const Eigen::Vector3d& p_HP) const {
    const Screws screws = ToScrews();
    RigidTransform X = RigidTransform::Identity();
    Kinematics result{{}, Eigen::MatrixXd(6, q.size())};
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const Screw& s = screws.moving[static_cast<std::size_t>(i)];
      const Eigen::Vector3d w = X.linear() * s.w;
      result.J.col(i) << X.linear() * s.v + X.translation().cross(w), w;
      X = X * Exp(s, q[i]);
    }
    result.X_BH = X * screws.home;
    const Eigen::Vector3d p_BP = result.X_BH * p_HP;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const Eigen::Vector3d w = result.J.col(i).tail<3>();
      result.J.col(i).head<3>() += w.cross(p_BP);
    }
    return result;
  }
};

inline Eigen::VectorXd RandomJoints(int n, Random* random) {
  return Eigen::VectorXd::NullaryExpr(n, [&] { return random->Uniform(-2.5, 2.5); });
}

/// Largest difference of any number of two poses.
inline double MaxDifference(const RigidTransform& X_1, const RigidTransform& X_2) {
  return (X_1.matrix() - X_2.matrix()).cwiseAbs().maxCoeff();
}

}  // namespace visavis
