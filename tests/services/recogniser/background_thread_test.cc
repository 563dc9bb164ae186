// BackgroundThread: work beside the caller's.
#include "services/recogniser/background_thread.h"

#include <gtest/gtest.h>

#include <future>
#include <thread>

namespace visavis {
namespace {

TEST(BackgroundThreadTest, IsNotWaitedForWhereTimeCounts) {
  std::promise<void> go;
  bool done = false;
  BackgroundThread thread(false);
  EXPECT_TRUE(thread.IsFinished());
  thread.Begin([&, ready = go.get_future().share()] {
    ready.wait();
    done = true;
  });
  EXPECT_FALSE(thread.IsFinished());
  go.set_value();
  while (!thread.IsFinished()) std::this_thread::yield();
  EXPECT_TRUE(done);
}

TEST(BackgroundThreadTest, IsWaitedForWhereEveryRunMustBeTheSame) {
  bool done = false;
  BackgroundThread thread(true);
  thread.Begin([&] {
    for (int i = 0; i < 1000; ++i) std::this_thread::yield();
    done = true;
  });
  EXPECT_TRUE(thread.IsFinished());
  EXPECT_TRUE(done);
}

TEST(BackgroundThreadTest, FinishesWhatItBeganBeforeItEnds) {
  bool done = false;
  {
    BackgroundThread thread(false);
    thread.Begin([&] {
      for (int i = 0; i < 1000; ++i) std::this_thread::yield();
      done = true;
    });
  }
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace visavis
