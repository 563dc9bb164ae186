#pragma once

#include <stdexcept>

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

}  // namespace visavis
