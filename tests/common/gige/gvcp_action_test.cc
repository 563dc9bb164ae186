#include "common/gige/gvcp_action.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/private_network.h"

namespace visavis {
namespace {

// GigE Vision 2.0, 16.9: key, flags (scheduled), command, length, number; keys; time.
TEST(GvcpActionTest, ThePacketIsThatOfTheStandard) {
  const auto packet =
      ScheduledAction({0x01020304, 0x11121314, 0x21222324}, 0x3132333435363738, 0x4142);
  const std::array<std::uint8_t, 28> expected{
      0x42, 0x80, 0x01, 0x00, 0x00, 0x14, 0x41, 0x42, 0x01, 0x02, 0x03, 0x04, 0x11, 0x12,
      0x13, 0x14, 0x21, 0x22, 0x23, 0x24, 0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x38};
  EXPECT_EQ(packet, expected);
}

TEST(GvcpActionTest, ItArrivesAtTheCamerasControlPort) {
  const std::string reason = EnterPrivateNetwork();
  if (!reason.empty()) GTEST_SKIP() << reason;
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(3956);
  inet_pton(AF_INET, "127.0.0.2", &name.sin_addr);
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  ASSERT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  const auto packet = ScheduledAction({}, 5, 1);
  EXPECT_TRUE(SendToCamera(packet, "127.0.0.2"));
  std::array<std::uint8_t, 100> received{};
  EXPECT_EQ(recv(fd, received.data(), received.size(), 0), 28);
  EXPECT_TRUE(std::equal(packet.begin(), packet.end(), received.begin()));
  EXPECT_FALSE(SendToCamera(packet, "no address"));
  close(fd);
}

}  // namespace
}  // namespace visavis
