#pragma once

#include "services/arm_state/sources/arm_source.h"
#include "visavis/iiwa_status_t.hpp"

namespace visavis {

/// Drake's driver of a KUKA iiwa: IIWA_STATUS.
class IiwaSource final : public MessageSource<iiwa_status_t> {
 public:
  using MessageSource::MessageSource;

 private:
  void Read(const iiwa_status_t& message, JointReading* reading) override {
    reading->utime_us = message.utime;
    reading->position = message.joint_position_measured;
    reading->velocity = message.joint_velocity_estimated;
  }
};

}  // namespace visavis
