#pragma once

#include <stdexcept>
#include <string>

#include "common/gige/gobject.h"

namespace visavis {

/// The camera cannot do what the configuration asks: "key: value: rule". Trying again is no use.
class CameraRefusal : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// The camera does not answer, or obeys another: it may work the next time.
class CameraLost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws CameraLost or CameraRefusal, whichever @p error is; nothing for no error.
/// @param key_value e.g. "camera.gain_db: 7", what was being set
void ThrowOnError(const GlibError& error, const std::string& key_value);

}  // namespace visavis
