#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

/// Throws std::invalid_argument naming the condition and the offending value.
/// For caller mistakes and outside data; always on.
#define VISAVIS_THROW_UNLESS(condition, value)                                               \
  do {                                                                                       \
    if (!(condition)) {                                                                      \
      std::ostringstream visavis_message;                                                    \
      visavis_message << __func__ << ": condition '" #condition "' failed, " #value << " = " \
                      << (value);                                                            \
      throw std::invalid_argument(visavis_message.str());                                    \
    }                                                                                        \
  } while (0)
