#include "common/rigs/rig_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/config/config_error.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr char kRight[] =
    "right: {width: 640, height: 480, fx: 800, fy: 801, cx: 319.5, cy: 239.5, "
    "distortion: [0.1, -0.2, 0.001, 0.002, 0.05]}\n";
constexpr char kLeft[] = "left: {width: 320, height: 240, fx: 400, fy: 401, cx: 159.5, cy: 119}\n";
constexpr char kXcl[] = "X_CL: {p_m: [-0.15, 0, 0], q_wxyz: [1, 0, 0, 0]}\n";
constexpr char kXhc[] = "X_HC: {p_m: [0, 0, 0.1], q_wxyz: [0.6, 0, 0.8, 0]}\n";
constexpr char kArm[] = "arm: {urdf: robot.urdf, base: b, tip: t}\n";
const std::string kCameras = std::string(kRight) + kLeft + kXcl;

class RigFileTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  RigDescription Load(const std::string& text) { return LoadRigFile(Write("rig.yaml", text)); }
  // The error line for a rig.yaml of this text, from the place on; empty if it was taken.
  std::string Refusal(const std::string& text) {
    try {
      Load(text);
      return "";
    } catch (const ConfigError& e) {
      const std::string line = e.what();
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      return line.rfind(folder_.path().string() + "/", 0) == 0
                 ? line.substr(folder_.path().string().size() + 1)
                 : line;
    }
  }
  TemporaryFolder folder_;
};

TEST_F(RigFileTest, TwoCamerasAreEnough) {
  const RigDescription d = Load(kCameras);
  EXPECT_EQ(d.rig.right.width, 640);
  EXPECT_EQ(d.rig.right.fy, 801);
  EXPECT_EQ(d.rig.right.distortion[1], -0.2);
  EXPECT_EQ(d.rig.left.cy, 119);
  EXPECT_FALSE(d.rig.left.has_distortion());
  EXPECT_EQ(d.rig.X_CL.translation().x(), -0.15);
  EXPECT_FALSE(d.X_HC.has_value());
  EXPECT_FALSE(d.arm.has_value());
}

TEST_F(RigFileTest, TheUrdfIsReadFromBesideTheFile) {
  Write("robot.urdf", "<robot name='r'/>\n");
  const RigDescription d = Load(kCameras + kXhc + kArm);
  ASSERT_TRUE(d.X_HC && d.arm);
  EXPECT_NEAR(d.X_HC->linear()(0, 2), 2 * 0.6 * 0.8, 1e-12);
  EXPECT_EQ(d.arm->urdf, "<robot name='r'/>\n");
  EXPECT_EQ(d.arm->base_link, "b");
  EXPECT_EQ(d.arm->tip_link, "t");
  EXPECT_EQ(d.arm->X_WB.matrix(), RigidTransform::Identity().matrix());
}

TEST_F(RigFileTest, WhatIsSavedLoadsBackEqual) {
  Write("robot.urdf", "<robot name='r'/>\r\n");
  RigDescription d = Load(kCameras + kXhc + kArm);
  d.rig.right.fx = 800.0 / 3;
  d.rig.X_CL = MakeTransform(ExpRotation({0.01, -0.02, 0.03}), {-0.1500000001, 1e-17, 0.3});
  d.arm->X_WB = MakeTransform(ExpRotation({1, 2, -1}), {1.0 / 3, -2, 3e5});
  TemporaryFolder other;
  SaveRigFile(d, other / "copy.yaml");
  const RigDescription e = LoadRigFile(other / "copy.yaml");
  EXPECT_EQ(e.rig.right.fx, d.rig.right.fx);
  EXPECT_EQ(e.rig.right.distortion, d.rig.right.distortion);
  EXPECT_EQ(e.rig.left.width, d.rig.left.width);
  EXPECT_EQ(e.rig.X_CL.translation(), d.rig.X_CL.translation());
  EXPECT_LT((e.rig.X_CL.matrix() - d.rig.X_CL.matrix()).norm(), 1e-15);
  EXPECT_LT((e.X_HC->matrix() - d.X_HC->matrix()).norm(), 1e-15);
  EXPECT_EQ(e.arm->X_WB.translation(), d.arm->X_WB.translation());
  EXPECT_LT((e.arm->X_WB.linear() - d.arm->X_WB.linear()).norm(), 1e-14);
  EXPECT_EQ(e.arm->urdf, d.arm->urdf);
  EXPECT_EQ(e.arm->tip_link, "t");
}

TEST_F(RigFileTest, CamerasAloneAreSavedWithoutTheRest) {
  SaveRigFile(Load(kCameras), folder_ / "copy.yaml");
  const RigDescription e = LoadRigFile(folder_ / "copy.yaml");
  EXPECT_FALSE(e.X_HC.has_value());
  EXPECT_FALSE(e.arm.has_value());
  EXPECT_FALSE(std::filesystem::exists(folder_ / "arm.urdf"));
}

TEST_F(RigFileTest, AConfigurationsRigFileIsEmptyOrCanBeReadWithItsArm) {
  const auto refusal = [](const std::string& text) {
    return ThrowsMessage<FieldError>(HasSubstr(text));
  };
  EXPECT_NO_THROW(RequireRigFile(""));
  const std::string rig = Write("rig.yaml", kCameras + kXhc + kArm);
  EXPECT_THAT([&] { RequireRigFile(rig); }, refusal("rig_file: " + rig + ": " + rig +
                                                    ":5: arm.urdf: robot.urdf: cannot be read"));
  Write("robot.urdf", "<robot name='r'/>\n");
  EXPECT_NO_THROW(RequireRigFile(rig));
  for (const std::string& name : {folder_ / "none.yaml", folder_.path().string()}) {
    EXPECT_THAT([&] { RequireRigFile(name); },
                refusal("rig_file: " + name + ": must be a file that exists, or empty"));
  }
}

TEST_F(RigFileTest, UncertaintiesAreKeptWithAndWithoutHandEyes) {
  const std::string text =
      kCameras +
      "uncertainty: {right: {fx: 0.5, distortion: [1, 2, 3, 4, 5]}, left: {cy: 0.25}, "
      "X_CL: {p_m: [1e-4, 2e-4, 3e-4], r_rad: [0.001, 0, 0.002]}}\n";
  RigDescription d = Load(text);
  ASSERT_TRUE(d.uncertainty.has_value());
  EXPECT_EQ(d.uncertainty->right.fx, 0.5);
  EXPECT_EQ(d.uncertainty->right.distortion[4], 5);
  EXPECT_EQ(d.uncertainty->left.cy, 0.25);
  EXPECT_EQ(d.uncertainty->X_CL.p_m[2], 3e-4);
  EXPECT_FALSE(d.uncertainty->X_HC.has_value());
  d.uncertainty->X_HC = PoseUncertainty{{1, 2, 3}, {4, 5, 6}};
  SaveRigFile(d, folder_ / "copy.yaml");
  const RigDescription e = LoadRigFile(folder_ / "copy.yaml");
  ASSERT_TRUE(e.uncertainty && e.uncertainty->X_HC);
  EXPECT_EQ(e.uncertainty->X_CL.r_rad, d.uncertainty->X_CL.r_rad);
  EXPECT_EQ(e.uncertainty->left.cy, 0.25);
  EXPECT_EQ(e.uncertainty->X_HC->r_rad[1], 5);
  EXPECT_FALSE(Load(kCameras).uncertainty.has_value());
  EXPECT_EQ(Refusal(kCameras + "uncertainty: {X_CL: {p_m: [0, -1, 0]}}\n"),
            "rig.yaml:4: uncertainty.X_CL.p_m: [0, -1, 0]: must be 3 numbers >= 0");
}

TEST_F(RigFileTest, ASavingThatFailsNamesTheFile) {
  EXPECT_THAT([&] { SaveRigFile(Load(kCameras), "/nonexistent/rig.yaml"); },
              ThrowsMessage<std::runtime_error>("/nonexistent/rig.yaml: cannot be written"));
}

TEST_F(RigFileTest, AMissingFileIsNamed) {
  EXPECT_THAT([] { LoadRigFile("/nonexistent/rig.yaml"); },
              ThrowsMessage<ConfigError>("/nonexistent/rig.yaml: cannot be read"));
}

TEST_F(RigFileTest, WhatMustBeGivenIsNamedWithItsPlace) {
  EXPECT_EQ(Refusal(std::string(kRight) + kLeft), "rig.yaml: X_CL: missing: must be given");
  EXPECT_EQ(Refusal(std::string(kLeft) + kXcl), "rig.yaml: right: missing: must be given");
  EXPECT_EQ(Refusal(std::string(kRight) + kXcl), "rig.yaml: left: missing: must be given");
  EXPECT_EQ(
      Refusal("left: {width: 3, height: 3, fx: 2, fy: 2, cy: 1}\n" + std::string(kRight) + kXcl),
      "rig.yaml:1: left.cx: missing: must be given");
  EXPECT_EQ(Refusal(kCameras + "arm: {base: b, tip: t}\n"),
            "rig.yaml:4: arm.urdf: missing: must be given");
  EXPECT_EQ(Refusal(kCameras + "X_HC: {p_m: [0, 0, 0]}\n"),
            "rig.yaml:4: X_HC.q_wxyz: missing: must be given");
}

TEST_F(RigFileTest, AValueThatBreaksItsRuleIsNamedWithItsLine) {
  EXPECT_EQ(Refusal(std::string(kRight) + "left: {width: 0}\n" + kXcl),
            "rig.yaml:2: left.width: 0: must be 1 to 16384 px");
  EXPECT_EQ(Refusal(std::string(kRight) + "left: {width: 640, fx: .nan}\n" + kXcl),
            "rig.yaml:2: left.fx: .nan: must be 1 to 1e+06 px");
  EXPECT_THAT(Refusal(std::string(kRight) + "left: {distortion: [1, 2, 3]}\n" + kXcl),
              HasSubstr("rig.yaml:2: left.distortion: [1, 2, 3]: must be a list"));
  EXPECT_THAT(Refusal(kCameras + "\n\nX_HC:\n  p_m: [0, 0, 0]\n  q_wxyz: [1, 1, 0, 0]\n"),
              HasSubstr("rig.yaml:8: X_HC.q_wxyz: norm 1.414214: must be 1 within 0.001"));
  EXPECT_EQ(
      Refusal(std::string(kRight) + kLeft + "X_CL: {p_m: [.inf, 0, 0], q_wxyz: [1, 0, 0, 0]}\n"),
      "rig.yaml:3: X_CL.p_m: not finite: must be three numbers in m");
  EXPECT_THAT(Refusal(kCameras + "colour: red\n"),
              HasSubstr("rig.yaml:4: colour: red: unknown key, must be one of X_CL X_HC arm left "
                        "right uncertainty"));
}

TEST_F(RigFileTest, WhatContradictsItselfIsNamedWithItsLine) {
  EXPECT_THAT(
      Refusal(std::string(kRight) + kLeft + "X_CL: {p_m: [-150, 0, 0], q_wxyz: [1, 0, 0, 0]}\n"),
      HasSubstr("rig.yaml:3: X_CL: contradictory"));
  EXPECT_THAT(Refusal(kCameras + "X_HC: {p_m: [0, 0, 90], q_wxyz: [1, 0, 0, 0]}\n"),
              HasSubstr("rig.yaml:4: X_HC: contradictory"));
  const std::string far_off =
      "left: {width: 320, height: 240, fx: 400, fy: 401, cx: 159.5, cy: 2000}\n";
  EXPECT_THAT(Refusal(std::string(kRight) + far_off + kXcl),
              HasSubstr("rig.yaml:2: left: contradictory"));
}

TEST_F(RigFileTest, AnArmThatCannotBeReadIsNamedWithItsLine) {
  EXPECT_EQ(Refusal(kCameras + kArm), "rig.yaml:4: arm.urdf: robot.urdf: cannot be read");
  std::filesystem::create_directory(folder_ / "robot.urdf");
  EXPECT_EQ(Refusal(kCameras + kArm), "rig.yaml:4: arm.urdf: robot.urdf: cannot be read");
  std::filesystem::remove(folder_ / "robot.urdf");
  Write("robot.urdf", "");
  EXPECT_EQ(Refusal(kCameras + kArm), "rig.yaml:4: arm.urdf: robot.urdf: is empty");
  Write("robot.urdf", "<robot/>");
  EXPECT_THAT(Refusal(kCameras + "arm: {urdf: robot.urdf, base: b, tip: b}\n"),
              HasSubstr("rig.yaml:4: arm: contradictory"));
}

}  // namespace
}  // namespace visavis
