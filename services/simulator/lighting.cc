#include "services/simulator/lighting.h"

namespace visavis {

Lighting Lighting::Side() {
  Lighting light;
  light.key_direction = {-0.93f, -0.26f, -0.26f};
  light.key = {1.05f, 1.00f, 0.93f};
  light.fill = {0.02f, 0.02f, 0.03f};
  light.sky = {0.10f, 0.11f, 0.13f};
  light.ground = {0.06f, 0.05f, 0.05f};
  return light;
}

}  // namespace visavis
