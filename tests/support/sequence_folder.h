#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/eventlog/event_log.h"
#include "tests/support/temporary_folder.h"

namespace visavis {

/// A small recorded sequence on disk that a test may spoil: 8x6 px pictures, 4 frames at 10 Hz,
/// camera poses and truth, the last row of truth missing.
class SequenceFolder {
 public:
  SequenceFolder();

  std::string path() const { return folder_.path().string(); }
  std::string File(const std::string& name) const { return folder_ / name; }
  /// Writes a file; an empty text removes it.
  void Write(const std::string& name, const std::string& text) const;
  std::string Read(const std::string& name) const;
  /// Replaces the first @p from of a file, which must be there.
  void Replace(const std::string& name, const std::string& from, const std::string& to) const;

 private:
  TemporaryFolder folder_;
};

/// A picture as PPM (or PGM, grey): pixel values count up from @p seed.
std::string MakePnm(int width, int height, bool grey, int seed);
/// The same picture's RGB (or grey) bytes.
std::vector<std::uint8_t> MakePixels(int width, int height, bool grey, int seed);
/// A small JPEG.
std::string MakeJpeg(int width, int height);

std::vector<LogEvent> ReadEvents(const std::string& log);

/// The events of one channel, decoded; a message that does not decode fails the test.
template <typename Message>
std::vector<Message> ReadMessages(const std::string& log, const std::string& channel) {
  std::vector<Message> messages;
  for (const auto& event : ReadEvents(log)) {
    if (event.channel != channel) continue;
    messages.emplace_back();
    const int size = static_cast<int>(event.data.size());
    if (messages.back().decode(event.data.data(), 0, size) != size) {
      throw std::runtime_error(channel + " does not decode");
    }
  }
  return messages;
}

}  // namespace visavis
