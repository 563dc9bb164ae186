#include "services/simulator/lighting.h"

namespace visavis {

Lighting Lighting::Side() {
  Lighting light;
  light.key_direction = {-0.93f, -0.26f, -0.26f};
  light.key = {0.95f, 0.91f, 0.85f};
  light.fill = {0.05f, 0.05f, 0.06f};
  light.sky = {0.16f, 0.17f, 0.19f};
  light.ground = {0.09f, 0.08f, 0.07f};
  return light;
}

}  // namespace visavis
