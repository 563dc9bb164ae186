#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace visavis {

/// One event of a standard LCM event log.
struct LogEvent {
  std::int64_t number{0};          ///< counted by the writer from 0
  std::int64_t utime{0};           ///< [us since Unix epoch] when it was received
  std::string channel;             ///< 1 to 256 bytes
  std::vector<std::uint8_t> data;  ///< the encoded message
};

/// Reads a standard LCM event log from its beginning to its end, past any damage: big-endian
/// EDA1DA01 | i64 number | i64 utime | i32 channel length | i32 data length | channel | data.
/// No byte of the file can make it crash, throw, or allocate more than the file holds.
///
/// An event is whole if its lengths fit into the file, and if behind it stand a magic word, the end
/// of the file, or damage. A length that leads past the next events is recognised by them: then
/// only the lying event is lost. What belongs to no whole event is skipped and counted.
class EventLogReader {
 public:
  /// Opens @p path. What is appended later is not seen.
  /// @throws std::runtime_error naming the file and the system's reason.
  explicit EventLogReader(const std::string& path);
  ~EventLogReader();
  EventLogReader(const EventLogReader&) = delete;
  EventLogReader& operator=(const EventLogReader&) = delete;

  /// Reads the next whole event; its memory is reused, so that nothing is allocated once it has
  /// held the largest event. @return false at the end, *event is then unspecified.
  /// @throws std::runtime_error if the system cannot read the file (never for its contents).
  bool Next(LogEvent* event);

  /// Back to the first event, all counts zero.
  void Rewind();

  std::int64_t num_events() const { return num_events_; }  ///< whole events read so far
  std::int64_t num_damaged_bytes() const {
    return damaged_bytes_;
  }  ///< skipped so far, tail included
  std::int64_t num_damaged_places() const { return damaged_places_; }  ///< runs of skipped bytes
  /// Bytes of the unfinished event at the end; known once Next() has returned false.
  std::int64_t num_truncated_bytes() const { return truncated_bytes_; }
  std::int64_t event_offset() const { return event_offset_; }  ///< of the last event in the file
  std::int64_t position() const { return position_; }  ///< [bytes] end of what was read or skipped
  std::int64_t file_size() const { return file_size_; }  ///< [bytes]
  const std::string& path() const { return path_; }

 private:
  struct Header;

  const std::uint8_t* Window(std::int64_t offset, std::size_t size);
  void CopyBytes(std::int64_t offset, std::size_t size, void* destination);
  void ReadBytes(std::int64_t offset, std::size_t size, void* destination);
  bool ReadHeader(std::int64_t offset, Header* header);
  std::int64_t FindHeader(std::int64_t begin, std::int64_t end);
  bool IsWhole(std::int64_t offset, const Header& header);
  void SkipTo(std::int64_t offset);

  std::string path_;
  int fd_{-1};
  std::int64_t file_size_{0};
  std::int64_t position_{0};
  std::int64_t event_offset_{0};
  std::int64_t num_events_{0};
  std::int64_t damaged_bytes_{0};
  std::int64_t damaged_places_{0};
  std::int64_t truncated_bytes_{0};
  std::vector<std::uint8_t> window_;  ///< bytes of the file from window_offset_
  std::int64_t window_offset_{0};
  std::size_t window_size_{0};
};

}  // namespace visavis
