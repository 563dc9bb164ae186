#include "services/stereo_capture/frame_queue.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <thread>

namespace visavis {
namespace {

CapturedFrame Numbered(std::uint64_t id) {
  CapturedFrame frame;
  frame.id = id;
  frame.pixels = std::make_shared<std::vector<std::uint8_t>>(1);
  return frame;
}

bool IsReadable(int fd) {
  pollfd poll_fd{fd, POLLIN, 0};
  return poll(&poll_fd, 1, 0) == 1;
}

TEST(FrameQueueTest, GivesFramesInOrderAndIsReadableWhileThereAreSome) {
  FrameQueue queue(4);
  EXPECT_FALSE(IsReadable(queue.fd()));
  EXPECT_FALSE(queue.Pop());
  for (std::uint64_t id = 0; id < 3; ++id) queue.Push(Numbered(id));
  for (std::uint64_t id = 0; id < 3; ++id) {
    EXPECT_TRUE(IsReadable(queue.fd()));
    EXPECT_EQ(queue.Pop()->id, id);
  }
  EXPECT_FALSE(IsReadable(queue.fd()));
  EXPECT_EQ(queue.num_dropped(), 0);
}

TEST(FrameQueueTest, DropsTheOldestWhenFullAndGivesItsMemoryBack) {
  FrameQueue queue(2);
  CapturedFrame first = Numbered(0);
  const std::weak_ptr<std::vector<std::uint8_t>> memory = first.pixels;
  queue.Push(std::move(first));
  queue.Push(Numbered(1));
  EXPECT_FALSE(memory.expired());
  queue.Push(Numbered(2));
  EXPECT_TRUE(memory.expired());
  EXPECT_EQ(queue.num_dropped(), 1);
  EXPECT_EQ(queue.Pop()->id, 1u);
  EXPECT_EQ(queue.Pop()->id, 2u);
}

TEST(FrameQueueTest, TwoThreadsMayPushWhileOnePops) {
  FrameQueue queue(100'000);
  const auto push = [&queue](std::uint64_t from) {
    for (std::uint64_t id = from; id < from + 10'000; ++id) queue.Push(Numbered(id));
  };
  std::thread first(push, 0), second(push, 1'000'000);
  std::uint64_t count = 0, next_first = 0, next_second = 1'000'000;
  while (count < 20'000) {
    const auto frame = queue.Pop();
    if (!frame) {
      std::this_thread::yield();
      continue;
    }
    ++count;
    std::uint64_t& next = frame->id < 1'000'000 ? next_first : next_second;
    EXPECT_EQ(frame->id, next);
    ++next;
  }
  first.join();
  second.join();
  EXPECT_FALSE(IsReadable(queue.fd()));
}

}  // namespace
}  // namespace visavis
