#pragma once

#include "services/arm_state/sources/arm_source.h"
#include "visavis/panda_status_t.hpp"

namespace visavis {

/// Drake's driver of a Franka Panda: PANDA_STATUS. Its times are the driver's, not the robot's own.
class PandaSource final : public MessageSource<panda_status_t> {
 public:
  using MessageSource::MessageSource;

 private:
  void Read(const panda_status_t& message, JointReading* reading) override {
    reading->utime_us = message.utime;
    reading->position = message.joint_position;
    reading->velocity = message.joint_velocity;
  }
};

}  // namespace visavis
