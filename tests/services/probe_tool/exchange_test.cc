#include "services/probe_tool/exchange.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/lcm_bus.h"

namespace visavis {
namespace {

void HandleAll(LcmBus* bus) {
  while (bus->HandleOne(0)) {
  }
}

TEST(ReceptionTest, CountsWhatCameOfWhatWasSentSinceTheFirst) {
  Reception reception;
  EXPECT_EQ(reception.sent(), 0);
  for (const std::int64_t seq : {7, 8, 11}) reception.Add(seq);
  EXPECT_EQ(reception.received, 3);
  EXPECT_EQ(reception.sent(), 5);
}

TEST(ReceptionTest, CountsNoNumberTwiceAndNoneBelowZero) {
  Reception reception;
  for (const std::int64_t seq : {3, 3, 2, 4, -1}) reception.Add(seq);
  EXPECT_EQ(reception.received, 2);
  EXPECT_EQ(reception.sent(), 2);
}

TEST(ExchangeTest, EachHearsTheOthersAndNotItself) {
  LcmBus bus("memq://", "");
  Exchange camera(&bus, "camera"), robot(&bus, "robot"), storage(&bus, "storage");
  for (int i = 0; i < 3; ++i) {
    camera.Send();
    HandleAll(&bus);
    robot.Send();
    HandleAll(&bus);
  }
  ASSERT_EQ(camera.peers().size(), 1u);
  EXPECT_EQ(camera.peers().at("robot").small.received, 3);
  EXPECT_EQ(camera.peers().at("robot").large.received, 3);
  EXPECT_EQ(robot.peers().count("robot"), 0u);
  EXPECT_EQ(storage.peers().size(), 2u);
}

TEST(ExchangeTest, ALostMessageIsMissingFromWhatCame) {
  LcmBus sending("memq://", ""), receiving("memq://", "");
  Exchange camera(&sending, "camera"), robot(&receiving, "robot");
  int num_forwarded = 0;
  sending.Subscribe<service_status_t>(Exchange::kSmallChannel, [&](const service_status_t& m) {
    if (num_forwarded++ != 1) receiving.Publish(Exchange::kSmallChannel, m);
  });
  for (int i = 0; i < 4; ++i) camera.Send();
  HandleAll(&sending);
  HandleAll(&receiving);
  const Exchange::Peer& peer = robot.peers().at("camera");
  EXPECT_EQ(peer.small.received, 3);
  EXPECT_EQ(peer.small.sent(), 4);
  EXPECT_EQ(peer.large.received, 0);
}

}  // namespace
}  // namespace visavis
