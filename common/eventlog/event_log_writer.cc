#include "common/eventlog/event_log_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "common/core/check.h"
#include "common/eventlog/event_log.h"

namespace visavis {
namespace {

constexpr std::size_t kBufferSize = 1 << 20;
constexpr std::size_t kHeaderSize = 28;
constexpr std::size_t kMaxChannelSize = 256;

template <typename T>
std::uint8_t* PutBigEndian(T value, std::uint8_t* out) {
  for (std::size_t i = sizeof(T); i-- > 0;) *out++ = static_cast<std::uint8_t>(value >> (8 * i));
  return out;
}

[[noreturn]] void Fail(const std::string& path, int error) {
  throw std::runtime_error(path + ": " + std::strerror(error));
}

}  // namespace

EventLogWriter::EventLogWriter(const std::string& path, Mode mode)
    : path_(path), buffer_(kBufferSize + kHeaderSize + kMaxChannelSize) {
  const int how = mode == Mode::kCreate ? O_EXCL : mode == Mode::kReplace ? O_TRUNC : 0;
  fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | how, 0644);
  if (fd_ < 0) Fail(path, errno);
  if (mode != Mode::kAppend) return;
  try {
    EventLogReader reader(path);
    LogEvent event;
    while (reader.Next(&event)) {
      next_number_ = static_cast<std::int64_t>(static_cast<std::uint64_t>(event.number) + 1);
      file_end_ = reader.position();
    }
  } catch (const std::runtime_error&) {
    close(fd_);
    throw;
  }
  if (ftruncate(fd_, file_end_) < 0 || lseek(fd_, file_end_, SEEK_SET) < 0) {
    const int error = errno;
    close(fd_);
    Fail(path, error);
  }
}

EventLogWriter::~EventLogWriter() {
  try {
    Close();
  } catch (const std::runtime_error&) {
  }
}

void EventLogWriter::Write(std::int64_t utime, const std::string& channel, const void* data,
                           std::size_t size) {
  VISAVIS_THROW_UNLESS(!channel.empty() && channel.size() <= kMaxChannelSize, channel);
  VISAVIS_THROW_UNLESS(size <= std::numeric_limits<std::int32_t>::max(), size);
  const std::size_t front = kHeaderSize + channel.size();
  const std::int64_t number = next_number_++;
  ++num_events_;
  num_bytes_ += static_cast<std::int64_t>(front + size);
  if (buffered_ + front + size > kBufferSize) {
    ++num_lost_;  // this event too, if flushing throws
    Flush();
    --num_lost_;
  }

  std::uint8_t* out = buffer_.data() + buffered_;
  out = PutBigEndian(0xEDA1DA01u, out);
  out = PutBigEndian(number, out);
  out = PutBigEndian(utime, out);
  out = PutBigEndian(static_cast<std::int32_t>(channel.size()), out);
  out = PutBigEndian(static_cast<std::int32_t>(size), out);
  out = std::copy(channel.begin(), channel.end(), out);
  if (front + size <= kBufferSize) {
    if (size > 0) std::memcpy(out, data, size);
    buffered_ += front + size;
    ++num_buffered_;
    return;
  }
  // Larger than the buffer: straight to the file.
  WriteOut(buffer_.data(), front, 1);
  WriteOut(static_cast<const std::uint8_t*>(data), size, 1);
  file_end_ += static_cast<std::int64_t>(front + size);
}

void EventLogWriter::Flush() {
  const std::size_t size = std::exchange(buffered_, 0);
  WriteOut(buffer_.data(), size, std::exchange(num_buffered_, 0));
  file_end_ += static_cast<std::int64_t>(size);
}

void EventLogWriter::Close() {
  if (fd_ < 0) return;
  const int fd = fd_;
  try {
    Flush();
  } catch (const std::runtime_error&) {
    fd_ = -1;
    close(fd);
    throw;
  }
  fd_ = -1;
  if (close(fd) < 0) Fail(path_, errno);
}

/// Writes bytes of @p num_events events; on failure cuts the file back to what was there before.
void EventLogWriter::WriteOut(const std::uint8_t* data, std::size_t size, std::int64_t num_events) {
  while (size > 0) {
    const ssize_t n = write(fd_, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int error = errno;
      num_lost_ += num_events;
      if (ftruncate(fd_, file_end_) == 0) lseek(fd_, file_end_, SEEK_SET);
      Fail(path_, error);
    }
    data += n;
    size -= static_cast<std::size_t>(n);
  }
}

}  // namespace visavis
