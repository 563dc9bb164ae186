#include "common/gige/interface_mtu.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/private_network.h"

namespace visavis {
namespace {

TEST(InterfaceMtuTest, IsThatOfTheInterfaceWithTheAddressOrItsNetwork) {
  const std::string reason = EnterPrivateNetwork();
  if (!reason.empty()) GTEST_SKIP() << reason;
  ASSERT_EQ(std::system(
                "ip link add cam0 type veth peer name cam1 && ip addr add 10.9.8.1/24 dev cam0 && "
                "ip link set cam0 mtu 8996 up && ip link set lo mtu 4000"),
            0);
  EXPECT_EQ(InterfaceMtu("10.9.8.1"), 8996);
  EXPECT_EQ(InterfaceMtu("10.9.8.77"), 8996);
  EXPECT_EQ(InterfaceMtu("127.0.0.1"), 4000);
}

TEST(InterfaceMtuTest, IsEthernetsWhereNoInterfaceFits) {
  EXPECT_EQ(InterfaceMtu("203.0.113.9"), 1500);
  EXPECT_EQ(InterfaceMtu(""), 1500);
  EXPECT_EQ(InterfaceMtu("camera"), 1500);
}

}  // namespace
}  // namespace visavis
