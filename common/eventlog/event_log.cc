#include "common/eventlog/event_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace visavis {
namespace {

constexpr std::size_t kHeaderSize = 28;
constexpr std::size_t kWindowSize = 1 << 16;
constexpr std::int64_t kMaxChannelSize = 256;
constexpr std::uint8_t kMagic[4] = {0xED, 0xA1, 0xDA, 0x01};

template <typename T>
T BigEndian(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = value << 8 | bytes[i];
  return static_cast<T>(value);
}

[[noreturn]] void Fail(const std::string& path, int error) {
  throw std::runtime_error(path + ": " + std::strerror(error));
}

}  // namespace

struct EventLogReader::Header {
  std::int64_t number, utime, channel_size, data_size;

  std::int64_t event_size() const {
    return static_cast<std::int64_t>(kHeaderSize) + channel_size + data_size;
  }
};

EventLogReader::EventLogReader(const std::string& path) : path_(path), window_(kWindowSize) {
  fd_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd_ < 0) Fail(path, errno);
  struct stat status {};
  int error = fstat(fd_, &status) < 0 ? errno : 0;
  if (error == 0 && S_ISDIR(status.st_mode)) error = EISDIR;
  if (error != 0) {
    close(fd_);
    Fail(path, error);
  }
  file_size_ = status.st_size;
}

EventLogReader::~EventLogReader() { close(fd_); }

void EventLogReader::Rewind() {
  position_ = event_offset_ = num_events_ = 0;
  damaged_bytes_ = damaged_places_ = truncated_bytes_ = 0;
}

bool EventLogReader::Next(LogEvent* event) {
  while (position_ < file_size_) {
    Header header{};
    if (ReadHeader(position_, &header) && IsWhole(position_, header)) {
      event->number = header.number;
      event->utime = header.utime;
      event->channel.resize(static_cast<std::size_t>(header.channel_size));
      event->data.resize(static_cast<std::size_t>(header.data_size));
      const std::int64_t channel = position_ + static_cast<std::int64_t>(kHeaderSize);
      CopyBytes(channel, event->channel.size(), event->channel.data());
      CopyBytes(channel + header.channel_size, event->data.size(), event->data.data());
      event_offset_ = position_;
      position_ += header.event_size();
      ++num_events_;
      return true;
    }
    SkipTo(FindHeader(position_ + 1, file_size_));
  }
  return false;
}

/// Counts the bytes up to @p offset as damaged: the unfinished tail if nothing stands behind them.
void EventLogReader::SkipTo(std::int64_t offset) {
  const std::uint8_t* start = Window(position_, sizeof kMagic);
  const auto left = static_cast<std::size_t>(file_size_ - position_);
  if (offset == file_size_ && std::memcmp(start, kMagic, std::min(left, sizeof kMagic)) == 0) {
    truncated_bytes_ = offset - position_;
  }
  damaged_bytes_ += offset - position_;
  ++damaged_places_;
  position_ = offset;
}

/// Whether the lengths stated at @p offset are true as far as what follows can tell.
bool EventLogReader::IsWhole(std::int64_t offset, const Header& header) {
  const std::int64_t end = offset + header.event_size();
  if (end == file_size_) return true;
  const auto rest = static_cast<std::size_t>(file_size_ - end);
  if (std::memcmp(Window(end, sizeof kMagic), kMagic, std::min(rest, sizeof kMagic)) == 0) {
    return true;
  }
  return FindHeader(offset + 1, end) == end;
}

/// Reads a header with lengths that are in range and fit into the file.
bool EventLogReader::ReadHeader(std::int64_t offset, Header* header) {
  const std::int64_t rest = file_size_ - offset;
  if (rest < static_cast<std::int64_t>(kHeaderSize)) return false;
  const std::uint8_t* bytes = Window(offset, kHeaderSize);
  header->number = BigEndian<std::int64_t>(bytes + 4);
  header->utime = BigEndian<std::int64_t>(bytes + 12);
  header->channel_size = BigEndian<std::int32_t>(bytes + 20);
  header->data_size = BigEndian<std::int32_t>(bytes + 24);
  return std::memcmp(bytes, kMagic, sizeof kMagic) == 0 && header->channel_size >= 1 &&
         header->channel_size <= kMaxChannelSize && header->data_size >= 0 &&
         header->event_size() <= rest;
}

/// Offset of the first possible header in [begin, end), or @p end.
std::int64_t EventLogReader::FindHeader(std::int64_t begin, std::int64_t end) {
  std::int64_t offset = begin;
  while (offset < end) {
    const std::uint8_t* bytes = Window(offset, 1);
    const std::int64_t window_end = window_offset_ + static_cast<std::int64_t>(window_size_);
    const auto size = static_cast<std::size_t>(std::min(end, window_end) - offset);
    const void* found = std::memchr(bytes, kMagic[0], size);
    if (found == nullptr) {
      offset += static_cast<std::int64_t>(size);
      continue;
    }
    offset += static_cast<const std::uint8_t*>(found) - bytes;
    Header header{};
    if (offset < end && ReadHeader(offset, &header)) return offset;
    ++offset;
  }
  return end;
}

/// At least @p size (at most kWindowSize) bytes of the file from @p offset; zeros behind its end.
const std::uint8_t* EventLogReader::Window(std::int64_t offset, std::size_t size) {
  const bool inside =
      offset >= window_offset_ && offset + static_cast<std::int64_t>(size) <=
                                      window_offset_ + static_cast<std::int64_t>(window_size_);
  if (!inside) {
    window_offset_ = offset;
    window_size_ = static_cast<std::size_t>(
        std::clamp<std::int64_t>(file_size_ - offset, 0, static_cast<std::int64_t>(kWindowSize)));
    ReadBytes(offset, window_size_, window_.data());
    if (window_size_ < size) {
      std::fill(window_.begin() + static_cast<std::ptrdiff_t>(window_size_), window_.end(),
                std::uint8_t{0});
    }
  }
  return window_.data() + (offset - window_offset_);
}

/// Copies @p size bytes at @p offset, out of the window where it holds them.
void EventLogReader::CopyBytes(std::int64_t offset, std::size_t size, void* destination) {
  const std::int64_t window_end = window_offset_ + static_cast<std::int64_t>(window_size_);
  if (size == 0) return;
  if (offset >= window_offset_ && offset + static_cast<std::int64_t>(size) <= window_end) {
    std::memcpy(destination, window_.data() + (offset - window_offset_), size);
  } else {
    ReadBytes(offset, size, destination);
  }
}

/// Reads @p size bytes at @p offset; zeros where the file became shorter since it was opened.
void EventLogReader::ReadBytes(std::int64_t offset, std::size_t size, void* destination) {
  auto* bytes = static_cast<std::uint8_t*>(destination);
  while (size > 0) {
    const ssize_t n = pread(fd_, bytes, size, offset);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) Fail(path_, errno);
    if (n == 0) {
      std::memset(bytes, 0, size);
      return;
    }
    bytes += n;
    offset += n;
    size -= static_cast<std::size_t>(n);
  }
}

}  // namespace visavis
