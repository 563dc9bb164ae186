#include "common/bus/lcm_bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "visavis/head_pose_t.hpp"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class LcmBusTest : public ::testing::Test {
 protected:
  LcmBus bus_{"memq://", "ROBOT1_"};
};

TEST_F(LcmBusTest, DeliversWhatWasPublished) {
  head_pose_t received{};
  bus_.Subscribe<head_pose_t>("A", [&](const head_pose_t& m) { received = m; });
  head_pose_t sent{};
  sent.seq = 7;
  sent.euler_zyx_CM_rad[2] = -0.25;
  bus_.Publish("A", sent);
  EXPECT_TRUE(bus_.HandleOne(100));
  EXPECT_EQ(received.seq, 7);
  EXPECT_EQ(received.euler_zyx_CM_rad[2], -0.25);
}

TEST_F(LcmBusTest, WithoutASubscriptionThereIsNothingToWaitFor) {
  EXPECT_EQ(bus_.fd(), -1);  // else LCM would receive what we publish ourselves
  bus_.Publish("A", head_pose_t{});
  EXPECT_EQ(bus_.fd(), -1);
  bus_.Subscribe<head_pose_t>("A", [](const head_pose_t&) {});
  EXPECT_GE(bus_.fd(), 0);
}

TEST_F(LcmBusTest, ThePrefixStandsBeforeTheChannel) {
  std::string name;
  bus_.SubscribeAll([&](const std::string& channel, const std::uint8_t*, int) { name = channel; },
                    5);
  bus_.Publish("A", head_pose_t{});
  bus_.HandleOne(100);
  EXPECT_EQ(name, "ROBOT1_A");
}

TEST_F(LcmBusTest, RethrowsAHandlersErrorOutsideLcmAndGoesOn) {
  int calls = 0;
  bus_.Subscribe<head_pose_t>("A", [&](const head_pose_t&) {
    if (++calls == 1) throw std::runtime_error("boom");
  });
  bus_.Publish("A", head_pose_t{});
  EXPECT_THAT([&] { bus_.HandleOne(100); }, ThrowsMessage<std::runtime_error>("boom"));
  bus_.Publish("A", head_pose_t{});
  EXPECT_TRUE(bus_.HandleOne(100));
  EXPECT_EQ(calls, 2);
}

TEST_F(LcmBusTest, AMessageOfTheWrongLengthIsRejectedByName) {
  struct Padded {  // A head_pose_t with one byte too many.
    int getEncodedSize() const { return message.getEncodedSize() + 1; }
    int encode(void* buf, int offset, int maxlen) const {
      return message.encode(buf, offset, maxlen);
    }
    head_pose_t message{};
  };
  int calls = 0;
  std::string rejected;
  bus_.set_reject_handler([&](const std::string& channel, const std::string& reason) {
    rejected = channel + " " + reason;
  });
  bus_.Subscribe<head_pose_t>("A", [&](const head_pose_t&) { ++calls; });
  bus_.Publish("A", Padded{});
  bus_.HandleOne(100);
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(bus_.num_rejected(), 1);
  EXPECT_THAT(rejected, HasSubstr("ROBOT1_A is no head_pose_t"));
}

TEST(LcmBusOpenTest, ThrowsOnABadUrl) {
  EXPECT_THAT([] { LcmBus("nonsense://", ""); },
              ThrowsMessage<std::runtime_error>(HasSubstr("nonsense://")));
}

TEST(LcmBusOpenTest, ReportsWhatTheKernelGranted) {
  LcmBus bus("udpm://239.255.76.67:17801?ttl=0&recv_buf_size=100000", "");
  EXPECT_EQ(bus.GetReceiveBuffer().granted_bytes, 0);  // nothing subscribed: no socket yet
  bus.Subscribe<head_pose_t>("A", [](const head_pose_t&) {});
  EXPECT_EQ(bus.GetReceiveBuffer().asked_bytes, 100000);
  EXPECT_EQ(bus.GetReceiveBuffer().granted_bytes, 100000);
  EXPECT_FALSE(bus.GetReceiveBuffer().too_small());
  EXPECT_TRUE((ReceiveBuffer{4194304, 212992}.too_small()));
}

}  // namespace
}  // namespace visavis
