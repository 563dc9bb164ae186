#pragma once

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace visavis {

/// A variable that the test command sets. @throws std::runtime_error where it is not set.
inline std::string Environment(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  if (!value) throw std::runtime_error(name + " is not set: run the test by ctest");
  return value;
}

}  // namespace visavis
