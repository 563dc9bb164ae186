#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace visavis {

/// Which cameras an action is for: those whose registers hold these keys.
struct ActionKeys {
  std::uint32_t device_key{1}, group_key{1}, group_mask{1};
};

/// The packet of an action command that a camera is to perform at a time of its own clock.
/// @param camera_time_ns by the cameras' common clock (PTP) @param number of the packet, not 0
std::array<std::uint8_t, 28> ScheduledAction(const ActionKeys& keys, std::uint64_t camera_time_ns,
                                             std::uint16_t number);

/// Sends a packet to a camera's control port. @return whether it left.
bool SendToCamera(const std::array<std::uint8_t, 28>& packet, const std::string& camera_address);

}  // namespace visavis
