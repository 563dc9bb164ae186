#include "services/simulator/gige_config.h"

#include <array>
#include <cstdio>

#include "common/config/config_error.h"

namespace visavis {
namespace {

void RequireAddress(const std::string& key, const std::string& address) {
  std::array<unsigned, 4> n{};
  int end = 0;
  const int read =
      std::sscanf(address.c_str(), "%3u.%3u.%3u.%3u%n", &n[0], &n[1], &n[2], &n[3], &end);
  bool is_address = read == 4 && static_cast<std::size_t>(end) == address.size();
  for (const unsigned number : n) is_address = is_address && number <= 255;
  if (!is_address) {
    throw FieldError(key, address, "must be an IPv4 address as 127.0.0.1");
  }
}

void RequireSerial(const std::string& key, const std::string& serial) {
  if (serial.empty() || serial.size() > 15) {
    throw FieldError(key, serial, "must be 1 to 15 characters");
  }
}

}  // namespace

void GigeConfig::ValidateOrThrow() const {
  RequireAddress("gige.left.address", left.address);
  RequireAddress("gige.right.address", right.address);
  RequireSerial("gige.left.serial", left.serial);
  RequireSerial("gige.right.serial", right.serial);
  if (left.address == right.address) {
    throw FieldError("gige.right.address", right.address, "must not be the left camera's");
  }
  if (left.serial == right.serial) {
    throw FieldError("gige.right.serial", right.serial, "must not be the left camera's");
  }
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (faults[i].address.empty()) continue;
    RequireAddress("gige.faults." + std::to_string(i) + ".address", faults[i].address);
  }
}

}  // namespace visavis
