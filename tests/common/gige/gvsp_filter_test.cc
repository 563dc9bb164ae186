#include "common/gige/gvsp_filter.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <vector>

namespace visavis {
namespace {

/// Two sockets of this host: one that is filtered, one that sends to it.
class GvspFilterTest : public ::testing::Test {
 protected:
  GvspFilterTest()
      : to_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)),
        from_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    name_.sin_family = AF_INET;
    name_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof name_;
    EXPECT_EQ(bind(to_, reinterpret_cast<const sockaddr*>(&name_), sizeof name_), 0);
    EXPECT_EQ(getsockname(to_, reinterpret_cast<sockaddr*>(&name_), &size), 0);
  }
  ~GvspFilterTest() override {
    close(to_);
    close(from_);
  }
  int port() const { return ntohs(name_.sin_port); }

  /// Whether a packet of this type byte, size and payload type arrives. Loopback delivers before
  /// sendto returns.
  bool Arrives(int type, std::size_t size, std::uint8_t payload_type = 1) {
    std::vector<std::uint8_t> packet(size, 0);
    if (size > 4) packet[4] = static_cast<std::uint8_t>(type);
    const std::size_t at = type & 0x80 ? 23 : 11;
    if (size > at) packet[at] = payload_type;
    EXPECT_EQ(sendto(from_, packet.data(), size, 0, reinterpret_cast<const sockaddr*>(&name_),
                     sizeof name_),
              static_cast<ssize_t>(size));
    std::vector<std::uint8_t> received(70'000);
    return recv(to_, received.data(), received.size(), 0) == static_cast<ssize_t>(size);
  }

  const int to_, from_;
  sockaddr_in name_{};
};

TEST_F(GvspFilterTest, PassesWholePacketsOfEachKindAndDropsShorterOnes) {
  ASSERT_EQ(FilterStreamSocket(port(), "127.0.0.1"), 1);
  const std::pair<int, std::size_t> kinds[] = {{0x01, 44}, {0x02, 16}, {0x03, 9},
                                               {0x81, 56}, {0x82, 28}, {0x83, 21}};
  for (const auto& [type, least] : kinds) {
    for (std::size_t size = 0; size < 70; ++size)
      EXPECT_EQ(Arrives(type, size), size >= least) << type << " " << size;
    EXPECT_TRUE(Arrives(type, 9000)) << type;
  }
}

TEST_F(GvspFilterTest, DropsKindsThatNoImageHas) {
  ASSERT_EQ(FilterStreamSocket(port(), "127.0.0.1"), 1);
  for (const int type : {0x00, 0x04, 0x05, 0x06, 0x07, 0x0f, 0x80, 0x84, 0x8f})
    EXPECT_FALSE(Arrives(type, 1000)) << type;
  EXPECT_TRUE(Arrives(0x73, 1000));  // reserved bits may be anything
}

TEST_F(GvspFilterTest, DropsLeadersAndTrailersOfWhatIsNoImage) {
  ASSERT_EQ(FilterStreamSocket(port(), "127.0.0.1"), 1);
  for (const int type : {0x01, 0x02, 0x81, 0x82}) {
    EXPECT_TRUE(Arrives(type, 100, 1)) << type;
    for (const int payload : {0, 2, 4, 6, 10, 0x41}) {
      EXPECT_FALSE(Arrives(type, 100, static_cast<std::uint8_t>(payload))) << payload;
    }
  }
  EXPECT_TRUE(Arrives(0x03, 100, 77));  // data says nothing of the kind
}

TEST_F(GvspFilterTest, DropsWhatAnotherAddressSends) {
  EXPECT_TRUE(Arrives(3, 100));
  ASSERT_EQ(FilterStreamSocket(port(), "192.0.2.7"), 1);
  EXPECT_FALSE(Arrives(3, 100));
}

TEST_F(GvspFilterTest, FindsNoSocketWhereThereIsNone) {
  EXPECT_EQ(FilterStreamSocket(0, "127.0.0.1"), 0);
  EXPECT_EQ(FilterStreamSocket(port(), "nonsense"), 0);
  EXPECT_TRUE(Arrives(0, 3));
}

}  // namespace
}  // namespace visavis
