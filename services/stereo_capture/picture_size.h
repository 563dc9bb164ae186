#pragma once

#include <string>

namespace visavis {

/// Width and height [px], e.g. those that a rig was calibrated at.
struct PictureSize {
  int width{0}, height{0};
};

/// "640x480"
inline std::string ToText(const PictureSize& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace visavis
