#include "common/eventlog/event_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <lcm/lcm-cpp.hpp>

#include "common/core/random.h"
#include "common/eventlog/event_log_writer.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::ElementsAre;

Bytes Payload(std::size_t size, int seed) {
  Bytes data(size);
  for (std::size_t i = 0; i < size; ++i)
    data[i] = static_cast<std::uint8_t>(i * 7 + i / 256 + seed);
  return data;
}

void Put(EventLogWriter* writer, int i, std::size_t size) {
  const Bytes data = Payload(size, i);
  writer->Write(std::int64_t{1000} * i, "CHANNEL_" + std::to_string(i), data.data(), data.size());
}

/// A log of @p n events of @p size bytes each.
void WriteLog(const std::string& path, int n, std::size_t size) {
  EventLogWriter writer(path, EventLogWriter::Mode::kReplace);
  for (int i = 0; i < n; ++i) Put(&writer, i, size);
  writer.Close();
}

Bytes ReadFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteFile(const std::string& path, const Bytes& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

/// Numbers of the whole events; each must carry the data that Put() gave it.
std::vector<std::int64_t> ReadNumbers(EventLogReader* reader) {
  std::vector<std::int64_t> numbers;
  LogEvent event;
  while (reader->Next(&event)) {
    const int i = static_cast<int>(event.number);
    EXPECT_EQ(event.utime, 1000 * i);
    EXPECT_EQ(event.channel, "CHANNEL_" + std::to_string(i));
    EXPECT_EQ(event.data, Payload(event.data.size(), i));
    numbers.push_back(event.number);
  }
  return numbers;
}

constexpr std::size_t kEventSize = 28 + 9;  // header and "CHANNEL_0", without data

TEST(EventLogTest, LiblcmReadsWhatWeWrite) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lcm";
  WriteLog(path, 5, 3'000'000);  // larger than the writer's buffer
  lcm::LogFile log(path, "r");
  for (int i = 0; i < 5; ++i) {
    const lcm::LogEvent* event = log.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, i);
    EXPECT_EQ(event->timestamp, 1000 * i);
    EXPECT_EQ(event->channel, "CHANNEL_" + std::to_string(i));
    const auto* data = static_cast<const std::uint8_t*>(event->data);
    EXPECT_EQ(Bytes(data, data + event->datalen), Payload(3'000'000, i));
  }
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST(EventLogTest, WritesTheBytesOfLiblcm) {
  const TemporaryFolder folder;
  const std::string ours = folder / "ours.lcm", theirs = folder / "theirs.lcm";
  {
    lcm::LogFile log(theirs, "w");
    for (int i = 0; i < 5; ++i) {
      Bytes data = Payload(100, i);
      lcm::LogEvent event{};
      event.timestamp = std::int64_t{1000} * i;
      event.channel = "CHANNEL_" + std::to_string(i);
      event.datalen = 100;
      event.data = data.data();
      ASSERT_EQ(log.writeEvent(&event), 0);
    }
  }
  WriteLog(ours, 5, 100);
  EXPECT_EQ(ReadFile(ours), ReadFile(theirs));
  EventLogReader reader(theirs);
  EXPECT_THAT(ReadNumbers(&reader), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_EQ(reader.num_damaged_bytes(), 0);
}

TEST(EventLogTest, EmptyEventsAndNegativeTimesSurvive) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lcm";
  {
    EventLogWriter writer(path, EventLogWriter::Mode::kCreate);
    writer.Write(-5, "X", nullptr, 0);
  }
  EventLogReader reader(path);
  LogEvent event;
  ASSERT_TRUE(reader.Next(&event));
  EXPECT_EQ(event.utime, -5);
  EXPECT_EQ(event.channel, "X");
  EXPECT_TRUE(event.data.empty());
  EXPECT_FALSE(reader.Next(&event));
}

TEST(EventLogTest, TruncatedTailEndsTheLogAtEveryLength) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lcm";
  WriteLog(path, 3, 20);
  const Bytes whole = ReadFile(path);
  const std::size_t event_size = kEventSize + 20;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    WriteFile(path, Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    EventLogReader reader(path);
    EXPECT_EQ(ReadNumbers(&reader).size(), size / event_size) << size;
    EXPECT_EQ(reader.num_truncated_bytes(), size % event_size) << size;
    EXPECT_EQ(reader.num_damaged_bytes(), size % event_size) << size;
  }
}

TEST(EventLogTest, LyingLengthsLoseOnlyTheirEvent) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lcm";
  WriteLog(path, 4, 50);
  const Bytes whole = ReadFile(path);
  const std::size_t second = kEventSize + 50;
  // Channel length at byte 20 of the event, data length at byte 24, big-endian.
  const std::vector<std::pair<std::size_t, Bytes>> lies = {{24, {0x7f, 0xff, 0xff, 0xff}},
                                                           {24, {0xff, 0xff, 0xff, 0xff}},
                                                           {24, {0x80, 0, 0, 0}},
                                                           {24, {0, 0, 0, 120}},
                                                           {20, {0, 0, 1, 1}},
                                                           {20, {0, 0, 0, 0}},
                                                           {20, {0x7f, 0xff, 0xff, 0xff}},
                                                           {20, {0xff, 0xff, 0xff, 0xff}}};
  for (const auto& [where, lie] : lies) {
    Bytes damaged = whole;
    std::copy(lie.begin(), lie.end(),
              damaged.begin() + static_cast<std::ptrdiff_t>(second + where));
    WriteFile(path, damaged);
    EventLogReader reader(path);
    EXPECT_THAT(ReadNumbers(&reader), ElementsAre(0, 2, 3));
    EXPECT_EQ(reader.num_damaged_bytes(), second);
    EXPECT_EQ(reader.num_damaged_places(), 1);
    EXPECT_EQ(reader.num_truncated_bytes(), 0);
  }
}

TEST(EventLogTest, GarbageBetweenEventsIsSkippedAndCounted) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lcm";
  WriteLog(path, 4, 50);
  Bytes bytes = ReadFile(path);
  // 200 kB of bytes that look like the start of a magic word, longer than the reader's window.
  bytes.insert(bytes.begin() + 2 * (kEventSize + 50), 200'000, std::uint8_t{0xED});
  WriteFile(path, bytes);
  EventLogReader reader(path);
  EXPECT_THAT(ReadNumbers(&reader), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(reader.num_damaged_bytes(), 200'000);
  reader.Rewind();
  EXPECT_THAT(ReadNumbers(&reader), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(reader.num_damaged_bytes(), 200'000);
}

TEST(EventLogTest, RandomDamageNeverThrowsAndEveryByteIsAccountedFor) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lcm";
  WriteLog(path, 10, 30);
  const Bytes whole = ReadFile(path);
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    Bytes damaged = whole;
    for (int k = 0; k < 8; ++k) {
      damaged[static_cast<std::size_t>(random.Index(static_cast<int>(whole.size())))] =
          static_cast<std::uint8_t>(random.Bits());
    }
    WriteFile(path, damaged);
    EventLogReader reader(path);
    LogEvent event;
    std::int64_t read = 0;
    while (reader.Next(&event)) read += 28 + event.channel.size() + event.data.size();
    EXPECT_EQ(read + reader.num_damaged_bytes(), whole.size());
  }
}

TEST(EventLogTest, ReaderReusesTheEventsMemory) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lcm";
  WriteLog(path, 9, 100'000);
  EventLogReader reader(path);
  LogEvent event;
  ASSERT_TRUE(reader.Next(&event));
  const auto* data = event.data.data();
  const auto* channel = event.channel.data();
  while (reader.Next(&event)) {
    EXPECT_EQ(event.data.data(), data);
    EXPECT_EQ(event.channel.data(), channel);
  }
}

TEST(EventLogTest, ErrorsNameTheFileAndTheReason) {
  using ::testing::ThrowsMessage;
  const TemporaryFolder folder;
  EXPECT_THAT(
      [&] { EventLogReader reader(folder / "none.lcm"); },
      ThrowsMessage<std::runtime_error>(folder / "none.lcm" + ": No such file or directory"));
  EXPECT_THAT([&] { EventLogReader reader(folder.path().string()); },
              ThrowsMessage<std::runtime_error>(folder.path().string() + ": Is a directory"));
  WriteLog(folder / "a.lcm", 1, 1);
  EXPECT_THAT([&] { EventLogWriter writer(folder / "a.lcm", EventLogWriter::Mode::kCreate); },
              ThrowsMessage<std::runtime_error>(folder / "a.lcm" + ": File exists"));
  EXPECT_THAT([] { WriteLog("/dev/full", 2, 10); },
              ThrowsMessage<std::runtime_error>("/dev/full: No space left on device"));
  EXPECT_THAT([] { WriteLog("/dev/full", 1, 2'000'000); },
              ThrowsMessage<std::runtime_error>("/dev/full: No space left on device"));
}

/// While it lives, files cannot grow beyond a size: what a full disk does to a writer.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST(EventLogTest, AfterAFullDiskTheLogEndsWithAWholeEventAndGoesOn) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lcm";
  EventLogWriter writer(path, EventLogWriter::Mode::kCreate);
  Put(&writer, 0, 1000);
  writer.Flush();
  {
    const FileSizeLimit limit(2500);
    Put(&writer, 1, 1000);
    Put(&writer, 2, 1000);
    EXPECT_THAT([&] { writer.Flush(); },
                ::testing::ThrowsMessage<std::runtime_error>(path + ": File too large"));
    EXPECT_EQ(writer.num_lost(), 2);
    EXPECT_THROW(Put(&writer, 3, 2'000'000), std::runtime_error);  // beyond the buffer
    EXPECT_EQ(writer.num_lost(), 3);
    Put(&writer, 4, 1000);
    Put(&writer, 5, 1000);
    EXPECT_THROW(Put(&writer, 6, 1'048'000), std::runtime_error);  // flushing those before
    EXPECT_EQ(writer.num_lost(), 6);
  }
  Put(&writer, 7, 1000);
  writer.Close();
  EXPECT_EQ(writer.num_events(), 8);
  EventLogReader reader(path);
  EXPECT_THAT(ReadNumbers(&reader), ElementsAre(0, 7));
  EXPECT_EQ(reader.num_damaged_bytes(), 0);
}

TEST(EventLogTest, AppendingCutsATruncatedTailAndContinuesTheNumbers) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.lcm";
  WriteLog(path, 3, 20);
  std::filesystem::resize_file(path, 3 * (kEventSize + 20) - 1);
  {
    EventLogWriter writer(path, EventLogWriter::Mode::kAppend);
    Put(&writer, 2, 20);
    Put(&writer, 3, 20);
    EXPECT_EQ(writer.num_events(), 2);
    EXPECT_EQ(writer.num_bytes(), 2 * (kEventSize + 20));
  }
  EventLogReader reader(path);
  EXPECT_THAT(ReadNumbers(&reader), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(reader.num_damaged_bytes(), 0);
}

}  // namespace
}  // namespace visavis
