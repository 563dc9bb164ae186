#pragma once

#include "services/arm_state/sources/arm_source.h"
#include "visavis/joint_state_t.hpp"

namespace visavis {

/// Joint states with names, as bot_core.joint_state_t: floats, so 1e-7 rad at best.
class JointStateSource final : public MessageSource<joint_state_t> {
 public:
  using MessageSource::MessageSource;

 private:
  void Read(const joint_state_t& message, JointReading* reading) override {
    reading->utime_us = message.utime;
    reading->names = message.joint_name;
    reading->position.assign(message.joint_position.begin(), message.joint_position.end());
    reading->velocity.assign(message.joint_velocity.begin(), message.joint_velocity.end());
  }
};

}  // namespace visavis
