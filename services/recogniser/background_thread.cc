#include "services/recogniser/background_thread.h"

#include <sys/resource.h>

#include <chrono>
#include <utility>

namespace visavis {
namespace {

constexpr int kNiceness = 10;

}  // namespace

BackgroundThread::~BackgroundThread() {
  if (work_.valid()) work_.wait();
}

void BackgroundThread::Begin(std::function<void()> work) {
  if (work_.valid()) work_.get();
  work_ = std::async(std::launch::async, [run = std::move(work)] {
    setpriority(PRIO_PROCESS, 0, kNiceness);  // of this thread alone, on Linux
    run();
  });
}

bool BackgroundThread::IsFinished() {
  if (!work_.valid()) return true;
  if (!waits_ && work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  work_.get();
  return true;
}

}  // namespace visavis
