#pragma once

#include <string>
#include <vector>

namespace visavis {

/// One GigE Vision camera as it answered.
struct GvcpDevice {
  std::string vendor, model, serial;
  std::string user_name;          ///< what its owner called it; may be empty
  std::string address;            ///< of the camera, dotted
  std::string interface_address;  ///< of this host, through which it is reached
};

/// Whether @p name is how someone may call this camera: its serial, its user's name, its address,
/// VENDOR-SERIAL or VENDOR-MODEL-SERIAL.
bool IsCalled(const GvcpDevice& device, const std::string& name);

/// Asks all networks of this host, this host itself, and @p addresses (dotted; names that are none
/// are left out) for cameras, and waits @p wait_ms for their answers. Each camera once, by address.
/// @throws std::system_error where no socket can be had.
std::vector<GvcpDevice> DiscoverGvcp(int wait_ms, const std::vector<std::string>& addresses);

}  // namespace visavis
