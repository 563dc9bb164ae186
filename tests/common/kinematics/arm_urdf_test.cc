// What an Arm makes of URDFs that are not its own: each refusal names what, value and rule.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/kinematics/arm.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string Joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& more = "<axis xyz='0 0 1'/>") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + more + "</joint>";
}

std::string Robot(const std::string& body, int num_links = 3) {
  std::string links;
  for (int i = 0; i < num_links; ++i) links += "<link name='l" + std::to_string(i) + "'/>";
  return "<robot name='r'>" + links + body + "</robot>";
}

const std::string kLimit = "<limit lower='-1' upper='1' velocity='1' effort='1'/>";
const std::string kGood = Robot(Joint("a", "continuous", "l0", "l1") +
                                Joint("b", "revolute", "l1", "l2", "<axis xyz='1 0 0'/>" + kLimit));

/// Checks that the URDF is refused in one line that holds @p parts, and that nothing is printed.
template <typename... Parts>
void ExpectRefused(const std::string& urdf, const std::string& base, const std::string& tip,
                   const Parts&... parts) {
  std::string refusal;
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  try {
    Arm(urdf, base, tip);
  } catch (const std::invalid_argument& e) {
    refusal = e.what();
  }
  const std::string printed =
      ::testing::internal::GetCapturedStderr() + ::testing::internal::GetCapturedStdout();
  EXPECT_EQ(printed, "");
  EXPECT_THAT(refusal, AllOf(StartsWith("arm: "), Not(HasSubstr("\n")), HasSubstr(parts)...));
}

TEST(ArmUrdfTest, GoodOneIsAccepted) { EXPECT_EQ(Arm(kGood, "l0", "l2").num_joints(), 2); }

TEST(ArmUrdfTest, RefusesTextThatIsNoUrdf) {
  ExpectRefused("", "l0", "l2", "URDF is empty");
  ExpectRefused("hello", "l0", "l2", "URDF cannot be read");
  ExpectRefused("<robot name='r'>\n<link name='l0>\n</robot>", "l0", "l2", "line ");
  ExpectRefused("<robot name='r'><link", "l0", "l2", "URDF cannot be read");
  ExpectRefused("<robot name='r'/>", "l0", "l2", "URDF cannot be read");
  ExpectRefused("<sdf/>", "l0", "l2", "holds no <robot>");
  ExpectRefused(std::string(5 << 20, ' '), "l0", "l2", "5242880 bytes", "at most 4194304");
}

TEST(ArmUrdfTest, RefusesNestingThatWouldOverflowTheStack) {
  std::string deep;
  for (int i = 0; i < 300'000; ++i) deep += "<a>";
  ExpectRefused(deep, "l0", "l2", "nests 300000 elements", "at most 256");
}

TEST(ArmUrdfTest, RefusesLinksThatAreNotThere) {
  ExpectRefused(kGood, "bse", "l2", "base link 'bse' must be a link of robot 'r'");
  ExpectRefused(kGood, "l0", "tool", "tip link 'tool' must be a link of robot 'r'");
  ExpectRefused(kGood, "l0", "", "tip link ''");
}

TEST(ArmUrdfTest, RefusesATipThatIsNotBelowTheBase) {
  ExpectRefused(kGood, "l2", "l0", "tip link 'l0' must lie below base link 'l2'");
}

TEST(ArmUrdfTest, RefusesPathsWithoutMovingJoints) {
  ExpectRefused(kGood, "l1", "l1", "0 moving joints", "1 to 64");
  ExpectRefused(Robot(Joint("a", "fixed", "l0", "l1"), 2), "l0", "l1", "0 moving joints");
}

TEST(ArmUrdfTest, RefusesMoreJointsThanAMessageHolds) {
  std::string joints;
  for (int i = 0; i < 65; ++i) {
    joints += Joint("j" + std::to_string(i), "continuous", "l" + std::to_string(i),
                    "l" + std::to_string(i + 1));
  }
  ExpectRefused(Robot(joints, 66), "l0", "l65", "65 moving joints", "1 to 64");
  EXPECT_EQ(Arm(Robot(joints, 66), "l0", "l64").num_joints(), 64);
}

TEST(ArmUrdfTest, RefusesFloatingAndPlanarJoints) {
  ExpectRefused(Robot(Joint("f", "floating", "l0", "l1"), 2), "l0", "l1",
                "joint 'f' has type floating", "must be revolute, continuous, prismatic or fixed");
  ExpectRefused(Robot(Joint("p", "planar", "l0", "l1"), 2), "l0", "l1",
                "joint 'p' has type planar");
  ExpectRefused(Robot(Joint("s", "spherical", "l0", "l1"), 2), "l0", "l1", "spherical");
}

TEST(ArmUrdfTest, IgnoresJointsThatAreNotOnThePath) {
  const std::string urdf =
      Robot(Joint("a", "continuous", "l0", "l1") + Joint("f", "floating", "l0", "l2"));
  EXPECT_EQ(Arm(urdf, "l0", "l1").num_joints(), 1);
}

TEST(ArmUrdfTest, RefusesCycles) {
  ExpectRefused(
      Robot(Joint("a", "continuous", "l0", "l1") + Joint("b", "continuous", "l1", "l0"), 2), "l0",
      "l1", "links above 'l0' form a cycle");
  // With a root beside the cycle urdfdom would be content.
  ExpectRefused(Robot(Joint("a", "continuous", "l1", "l2") + Joint("b", "continuous", "l2", "l1")),
                "l0", "l2", "links above 'l1' form a cycle, must form a tree");
}

TEST(ArmUrdfTest, RefusesChainsSoLongThatFreeingThemWouldOverflowTheStack) {
  std::string joints;
  for (int i = 0; i < 20'000; ++i) {
    joints += Joint("j" + std::to_string(i), "fixed", "l" + std::to_string(i),
                    "l" + std::to_string(i + 1));
  }
  ExpectRefused(Robot(joints, 20'001), "l0", "l1", "more than 1000 joints");
}

TEST(ArmUrdfTest, RefusesALinkWithTwoParents) {
  ExpectRefused(Robot(Joint("a", "continuous", "l0", "l1") + Joint("b", "continuous", "l0", "l2") +
                      Joint("c", "continuous", "l1", "l2")),
                "l0", "l2", "link 'l2' is the child of joints 'b' and 'c'", "must have one parent");
}

TEST(ArmUrdfTest, RefusesNumbersThatAreNone) {
  for (const std::string xyz : {"0 zero 1", "nan 0 1", "inf 0 0", "0 0", "0 0 1 0", "1e999 0 0"}) {
    SCOPED_TRACE(xyz);
    ExpectRefused(Robot(Joint("a", "continuous", "l0", "l1", "<origin xyz='" + xyz + "'/>"), 2),
                  "l0", "l1", "URDF cannot be read");
    ExpectRefused(Robot(Joint("a", "continuous", "l0", "l1", "<axis xyz='" + xyz + "'/>"), 2), "l0",
                  "l1", "URDF cannot be read");
  }
  ExpectRefused(Robot(Joint("a", "revolute", "l0", "l1",
                            "<limit lower='x' upper='1' velocity='1' effort='1'/>"),
                      2),
                "l0", "l1", "URDF cannot be read", "lower");
}

TEST(ArmUrdfTest, RefusesAxesWithoutDirection) {
  ExpectRefused(Robot(Joint("a", "continuous", "l0", "l1", "<axis xyz='0 0 0'/>"), 2), "l0", "l1",
                "joint 'a' has axis of length 0", "must not be 0");
}

TEST(ArmUrdfTest, RefusesLimitsThatCannotBeKept) {
  const auto with_limit = [](const std::string& limit) {
    return Robot(Joint("a", "prismatic", "l0", "l1", "<axis xyz='0 0 1'/>" + limit), 2);
  };
  ExpectRefused(with_limit(""), "l0", "l1", "[a]", "PRISMATIC without limits");
  ExpectRefused(with_limit("<limit lower='1' upper='-1' velocity='1' effort='1'/>"), "l0", "l1",
                "joint 'a' has limits 1.000000 to -1.000000", "lower must be below upper");
  ExpectRefused(with_limit("<limit lower='0' upper='1' velocity='-1' effort='1'/>"), "l0", "l1",
                "limit velocity -1.000000", "must be >= 0");
  const Arm arm(with_limit("<limit lower='0' upper='1' velocity='0' effort='1'/>"), "l0", "l1");
  EXPECT_EQ(arm.joints()[0].max_speed, std::numeric_limits<double>::infinity());
}

TEST(ArmUrdfTest, RefusesJointsThatMimicOthers) {
  ExpectRefused(Robot(Joint("a", "continuous", "l0", "l1") +
                      Joint("m", "continuous", "l1", "l2", "<mimic joint='a'/>")),
                "l0", "l2", "joint 'm' mimics 'a'");
}

TEST(ArmUrdfTest, NamesFromOutsideStayOnOneShortLine) {
  ExpectRefused(kGood, "l0", std::string(10'000, 'x') + "\n", "xxx...'");
  ExpectRefused(kGood, "l\n0", "l2", "'l 0'");
}

}  // namespace
}  // namespace visavis
