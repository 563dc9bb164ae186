// What the recogniser holds in memory over a long replay, by its own status: little, and no more at
// the end than early on. VISAVIS_MEMORY_PAIRS: how many pairs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "common/convert/image_message.h"
#include "common/eventlog/event_log.h"
#include "common/image/image_decoder.h"
#include "tests/support/child_process.h"
#include "tests/support/log_writing.h"
#include "tests/support/malloc_counter.h"
#include "tests/support/temporary_folder.h"
#include "visavis/head_pose_t.hpp"
#include "visavis/images_t.hpp"
#include "visavis/rigid_transform_t.hpp"
#include "visavis/service_status_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {
namespace {

constexpr double kMost_mb = 60, kFlat_mb = 1;
constexpr std::size_t kSettledS = 5;  // a head was lost and found by then
constexpr std::int64_t kPeriodUs = 33'333;
constexpr int kAwayEvery = 50, kAway = 3;  // pairs

std::string Bin(const std::string& name) {
  return std::string(std::getenv("VISAVIS_BIN_DIR")) + "/" + name;
}

template <typename Message>
std::vector<Message> ReadAll(const std::string& log, const std::string& channel) {
  std::vector<Message> messages;
  EventLogReader reader(log);
  LogEvent event;
  while (reader.Next(&event)) {
    if (event.channel != channel) continue;
    messages.emplace_back();
    messages.back().decode(event.data.data(), 0, static_cast<int>(event.data.size()));
  }
  return messages;
}

/// A pair in which nobody is.
images_t EmptyPair(int width, int height) {
  const std::vector<std::uint8_t> wall(static_cast<std::size_t>(3 * width * height), 150);
  JpegEncoder encoder;
  images_t pair{};
  pair.n_images = 2;
  pair.image_types = {images_t::LEFT, images_t::RIGHT};
  pair.images.resize(2);
  for (image_t& image : pair.images) {
    SetImage(
        encoder.Encode({wall.data(), width, height, 3 * width, wall.size(), PixelFormat::kRgb}, 90),
        0, &image);
  }
  return pair;
}

/// The sample's pairs to and fro for @p pairs frames; now and then nobody is there.
void WriteLongLog(const std::string& sample, const std::string& path, int pairs) {
  const auto rigs = ReadAll<stereo_rig_t>(sample, "STEREO_RIG");
  auto images = ReadAll<images_t>(sample, "STEREO_IMAGES");
  auto poses = ReadAll<rigid_transform_t>(sample, "CAMERA_POSE");
  ASSERT_FALSE(rigs.empty());
  ASSERT_GE(images.size(), 10u);
  ASSERT_EQ(poses.size(), images.size());
  images_t empty = EmptyPair(rigs[0].right.width, rigs[0].right.height);
  EventLogWriter writer(path, EventLogWriter::Mode::kReplace);
  WriteMessage("STEREO_RIG", rigs[0], &writer);
  const int period = 2 * static_cast<int>(images.size()) - 2;
  for (int i = 0; i < pairs; ++i) {
    const auto k = static_cast<std::size_t>(std::min(i % period, period - i % period));
    const std::int64_t utime_us = rigs[0].utime + i * kPeriodUs;
    poses[k].utime = utime_us;
    WriteMessage("CAMERA_POSE", poses[k], &writer);
    images_t& pair = i % kAwayEvery >= kAwayEvery - kAway ? empty : images[k];
    pair.utime = utime_us;
    for (image_t& image : pair.images) image.utime = utime_us;
    WriteMessage("STEREO_IMAGES", pair, &writer);
  }
  writer.Close();
}

TEST(RecogniserMemoryTest, ItIsBelowSixtyMegabytesAndFlatOverALongReplay) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer's own memory is beside the point";
  const char* asked = std::getenv("VISAVIS_MEMORY_PAIRS");
  const int pairs = asked ? std::atoi(asked) : 300;
  const TemporaryFolder folder;
  const std::string data =
      std::string(std::getenv("VISAVIS_SOURCE_DIR")) + "/tests/data/man_shuttle";
  ASSERT_EQ(RunProcess({Bin("visavis-log"), "import", data, folder / "sample.lcm"}).exit_code, 0);
  WriteLongLog(folder / "sample.lcm", folder / "in.lcm", pairs);
  const ProcessResult run = RunProcess(
      {Bin("visavis-recogniser"), "--replay", folder / "in.lcm", "--record", folder / "out.lcm"},
      {}, std::chrono::minutes(10));
  ASSERT_EQ(run.exit_code, 0) << run.err;

  const auto poses = ReadAll<head_pose_t>(folder / "out.lcm", "HEAD_POSE");
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(pairs));
  const auto count = [&](int status) {
    return std::count_if(poses.begin(), poses.end(),
                         [&](const head_pose_t& pose) { return pose.status == status; });
  };
  EXPECT_GT(count(head_pose_t::STATUS_TRACKING), pairs * 8 / 10);              // it worked, and
  EXPECT_GT(count(head_pose_t::STATUS_LOST), pairs * kAway / kAwayEvery / 2);  // it searched

  const auto status = ReadAll<service_status_t>(folder / "out.lcm", "SERVICE_STATUS");
  ASSERT_GE(status.size(), 8u);
  const double early_mb = status[kSettledS].memory_mb;
  for (std::size_t i = 0; i < status.size(); ++i) {
    EXPECT_GT(status[i].memory_mb, 1) << i;
    EXPECT_LT(status[i].memory_mb,
              i > kSettledS ? std::min(early_mb + kFlat_mb, kMost_mb) : kMost_mb)
        << i;
  }
}

}  // namespace
}  // namespace visavis
