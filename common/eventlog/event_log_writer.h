#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace visavis {

/// Writes a standard LCM event log (see event_log.h), through a buffer of its own.
class EventLogWriter {
 public:
  enum class Mode {
    kCreate,   ///< a new file; refused where one exists
    kReplace,  ///< a new file in the place of what was there
    kAppend,   ///< behind the last whole event of an existing file (an unfinished tail is cut
               ///< off first, or readers stop there), numbers continued; else a new file
  };

  /// @throws std::runtime_error naming the file and the system's reason.
  EventLogWriter(const std::string& path, Mode mode);
  /// Writes what is buffered; a failure there is lost: call Close() to learn of it.
  ~EventLogWriter();
  EventLogWriter(const EventLogWriter&) = delete;
  EventLogWriter& operator=(const EventLogWriter&) = delete;

  /// Appends one event, numbered from 0. @p channel has 1 to 256 bytes (LCM sends at most 63),
  /// @p size is at most 2^31 - 1. No allocation.
  /// @throws std::invalid_argument for such a length, std::runtime_error naming the file and the
  /// system's reason (a full disk): the file then ends with a whole event, what was buffered is
  /// lost, and later events go behind the last one that was written.
  void Write(std::int64_t utime, const std::string& channel, const void* data, std::size_t size);

  /// Hands what is buffered to the system. @throws as Write().
  void Flush();

  /// Flush, and close the file. @throws as Write().
  void Close();

  std::int64_t num_events() const { return num_events_; }  ///< given to Write() so far
  std::int64_t num_bytes() const { return num_bytes_; }    ///< their size in the file
  std::int64_t num_lost() const { return num_lost_; }      ///< of these, lost when writing failed
  const std::string& path() const { return path_; }

 private:
  void WriteOut(const std::uint8_t* data, std::size_t size, std::int64_t num_events);

  std::string path_;
  int fd_{-1};
  std::int64_t file_end_{0};  ///< [bytes] behind the last whole event in the file
  std::int64_t next_number_{0};
  std::int64_t num_events_{0};
  std::int64_t num_bytes_{0};
  std::int64_t num_lost_{0};
  std::int64_t num_buffered_{0};
  std::vector<std::uint8_t> buffer_;  ///< whole events, not yet in the file
  std::size_t buffered_{0};
};

}  // namespace visavis
