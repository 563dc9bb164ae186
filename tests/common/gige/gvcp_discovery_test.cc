#include "common/gige/gvcp_discovery.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/gige/fake_camera.h"
#include "tests/support/private_network.h"

namespace visavis {
namespace {

class GvcpDiscoveryTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string reason = EnterPrivateNetwork();
    if (!reason.empty()) GTEST_SKIP() << reason;
  }
  static FakeCamera::Options At(const std::string& address, const std::string& serial) {
    FakeCamera::Options options;
    options.address = address;
    options.serial = serial;
    return options;
  }
};

TEST_F(GvcpDiscoveryTest, FindsEveryCameraOnceWithNamesAndAddresses) {
  const FakeCamera left(At("127.0.0.1", "L7"), nullptr), right(At("127.0.0.2", "R7"), nullptr);
  auto found = DiscoverGvcp(100, {"127.0.0.2", "no address"});
  ASSERT_EQ(found.size(), 2u);
  std::sort(found.begin(), found.end(),
            [](const GvcpDevice& a, const GvcpDevice& b) { return a.serial < b.serial; });
  EXPECT_EQ(found[0].serial, "L7");
  EXPECT_EQ(found[0].address, "127.0.0.1");
  EXPECT_EQ(found[0].vendor, "Aravis");
  EXPECT_EQ(found[0].model, "Fake");
  EXPECT_EQ(found[1].serial, "R7");
  EXPECT_EQ(found[1].address, "127.0.0.2");
  EXPECT_THAT(found[1].interface_address, ::testing::StartsWith("127.0.0."));
}

TEST_F(GvcpDiscoveryTest, NobodyThereIsAnEmptyAnswerInTheTimeGiven) {
  EXPECT_TRUE(DiscoverGvcp(30, {"127.0.0.2", "192.0.2.77"}).empty());
}

TEST(GvcpNamesTest, ACameraIsCalledBySerialUsersNameAddressOrAravisNames) {
  const GvcpDevice device{"Acme", "Eye 2", "1234", "left eye", "10.0.0.5", "10.0.0.1"};
  for (const char* name : {"1234", "left eye", "10.0.0.5", "Acme-1234", "Acme-Eye 2-1234"}) {
    EXPECT_TRUE(IsCalled(device, name)) << name;
  }
  for (const char* name : {"", "123", "Acme", "Eye 2", "10.0.0.1"}) {
    EXPECT_FALSE(IsCalled(device, name)) << name;
  }
  EXPECT_FALSE(IsCalled(GvcpDevice{}, ""));
}

}  // namespace
}  // namespace visavis
