#include "services/logger/logger_service.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "common/bus/lcm_bus.h"
#include "services/logger/log_name.h"

namespace visavis {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxCopies = 1000;  // logs begun within one second
constexpr std::int64_t kDrainUs = 1'000'000;
constexpr int kQuietMs = 20;

std::unique_ptr<EventLogWriter> OpenLog(const LoggerConfig& config, std::int64_t now_us) {
  std::error_code error;
  fs::create_directories(config.folder, error);
  if (error) throw std::runtime_error(config.folder + ": " + error.message());
  for (int copy = 0;; ++copy) {
    const std::string path =
        (fs::path(config.folder) / LogName(config.name, now_us, copy)).string();
    try {
      return std::make_unique<EventLogWriter>(path, EventLogWriter::Mode::kCreate);
    } catch (const std::runtime_error&) {
      if (copy >= kMaxCopies || !fs::exists(path)) throw;
    }
  }
}

std::uint64_t Fingerprint(const std::uint8_t* data, int size) {
  std::uint64_t fingerprint = 0;
  for (int i = 0; i < 8 && size >= 8; ++i) fingerprint = fingerprint << 8 | data[i];
  return fingerprint;
}

}  // namespace

ServiceTraits LoggerService::Traits() {
  ServiceTraits traits;
  traits.name = "logger";
  traits.description = "Writes what is on the bus to a standard LCM event log";
  traits.aliases = {{"--folder", "folder", "where logs go"},
                    {"--images", "images", "all, jpeg or none"}};
  return traits;
}

LoggerService::LoggerService(const LoggerConfig& config, const ServiceContext& context)
    : config_(config),
      context_(context),
      filter_(config.include, config.exclude),
      writer_(OpenLog(config, context.clock->NowUs())) {
  next_flush_us_ = context_.clock->NowUs() + std::int64_t{1000} * config_.flush_ms;
  context_.bus->SubscribeAll([this](const std::string& channel, const std::uint8_t* data,
                                    int size) { OnMessage(channel, data, size); },
                             config_.queue_capacity);
}

template <typename Write>
bool LoggerService::Guard(const Write& write) {
  const std::int64_t lost_before = writer_->num_lost();
  try {
    write();
    return true;
  } catch (const std::runtime_error& e) {
    context_.status->SetCondition("write", e.what());
    context_.status->Error(e.what(), context_.clock->NowUs());
    context_.status->Dropped(writer_->num_lost() - lost_before);
    return false;
  }
}

void LoggerService::OnMessage(const std::string& channel, const std::uint8_t* data, int size) {
  if (!filter_.Takes(channel) || IsUnwantedImage(data, size)) {
    ++num_left_out_;
    return;
  }
  Guard([&] {
    writer_->Write(context_.clock->NowUs(), channel, data, static_cast<std::size_t>(size));
    context_.status->Processed(std::nan(""));
  });
}

bool LoggerService::IsUnwantedImage(const std::uint8_t* data, int size) {
  if (config_.images == "all") return false;
  const std::uint64_t fingerprint = Fingerprint(data, size);
  if (fingerprint == static_cast<std::uint64_t>(image_t::getHash())) {
    image_t image;
    return config_.images == "none" || image.decode(data, 0, size) != size ||
           image.pixelformat != image_t::PIXELFORMAT_MJPEG;
  }
  if (fingerprint != static_cast<std::uint64_t>(images_t::getHash())) return false;
  if (config_.images == "none" || images_.decode(data, 0, size) != size) return true;
  return std::any_of(images_.images.begin(), images_.images.end(), [](const image_t& image) {
    return image.pixelformat != image_t::PIXELFORMAT_MJPEG;
  });
}

void LoggerService::Wake() {
  next_flush_us_ = context_.clock->NowUs() + std::int64_t{1000} * config_.flush_ms;
  if (Guard([this] { writer_->Flush(); })) context_.status->SetCondition("write", "");
}

void LoggerService::UpdateStatus() {
  context_.status->SetCounter("events", writer_->num_events());
  context_.status->SetCounter("bytes", writer_->num_bytes());
  context_.status->SetCounter("left_out", num_left_out_);
  std::error_code error;
  const fs::space_info space = fs::space(config_.folder, error);
  const auto free_mb = static_cast<std::int64_t>(space.available / 1'000'000);
  const bool low = !error && free_mb < config_.min_free_mb;
  context_.status->SetCondition(
      "disk", low ? config_.folder + ": " + std::to_string(free_mb) + " MB left on the disk" : "");
}

/// Messages that came before the stop signal may still wait in the bus.
void LoggerService::Drain() {
  auto* bus = dynamic_cast<LcmBus*>(context_.bus);
  if (!bus) return;
  const std::int64_t end_us = context_.clock->NowUs() + kDrainUs;
  while (context_.clock->NowUs() < end_us && bus->HandleOne(kQuietMs)) {
  }
}

void LoggerService::Finish() {
  Drain();
  writer_->Close();
}

}  // namespace visavis
