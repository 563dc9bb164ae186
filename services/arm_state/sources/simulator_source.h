#pragma once

#include "services/arm_state/sources/arm_source.h"
#include "visavis/arm_state_t.hpp"

namespace visavis {

/// The simulator's trajectory, or whoever else publishes arm_state_t, on a channel of its own.
class SimulatorSource final : public MessageSource<arm_state_t> {
 public:
  using MessageSource::MessageSource;

 private:
  void Read(const arm_state_t& message, JointReading* reading) override {
    reading->utime_us = message.utime;
    reading->names = message.joint_names;
    reading->position = message.joint_position;
    reading->velocity = message.joint_velocity;
  }
};

}  // namespace visavis
