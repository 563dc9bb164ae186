#include <array>
#include <cmath>

#include "services/simulator/bake.h"
#include "services/simulator/figure.h"
#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

/// A rounded piece from @p a to @p b [mm] with a radius at each end, flattened by @p flat along z.
struct Limb {
  Vector3d a, b;
  double ra, rb, flat;

  Vector3d At(double u, double v) const {
    // v runs from the pole beyond a to the pole beyond b, u round the axis.
    const Vector3d axis = (b - a).normalized();
    const Vector3d side = axis.cross(Vector3d::UnitZ()).normalized(), front = side.cross(axis);
    const double angle = 2 * M_PI * u, polar = M_PI * v, along = SmoothStep(0.25, 0.75, v);
    const double r = ra + along * (rb - ra);
    const Vector3d round = std::sin(polar) * (std::cos(angle) * side + std::sin(angle) * front);
    Vector3d p = r * (round - std::cos(polar) * axis);
    p.z() *= flat;
    return a + along * (b - a) + p;
  }
};

/// Fingers, thumb, palm and wrist of a right hand seen from its back.
std::array<Limb, 12> Limbs() {
  return {{
      {{0, 42, 0}, {0, -38, 0}, 40, 43, 0.36},  // palm
      {{0, 130, 2}, {0, 40, 1}, 29, 31, 0.66},  // wrist
      {{-31, -36, 0}, {-42, -84, 2}, 9.5, 8.6, 1},
      {{-42, -84, 2}, {-46, -118, 6}, 8.6, 7.0, 1},
      {{-11, -44, 0}, {-14, -98, 1}, 10, 9, 1},
      {{-14, -98, 1}, {-15, -138, 5}, 9, 7.3, 1},
      {{10, -43, 0}, {15, -93, 1}, 9.6, 8.7, 1},
      {{15, -93, 1}, {18, -129, 5}, 8.7, 7.0, 1},
      {{30, -36, 0}, {40, -74, 2}, 8.4, 7.5, 1},
      {{40, -74, 2}, {46, -100, 6}, 7.5, 6.2, 1},
      {{-34, 20, 2}, {-66, -18, 6}, 13, 10.5, 1},
      {{-66, -18, 6}, {-80, -48, 10}, 10.5, 8.2, 1},
  }};
}

}  // namespace

std::vector<Part> BuildHand(const Srgb& skin) {
  std::vector<Part> parts;
  for (const Limb& limb : Limbs()) {
    Mesh mesh = MakeGrid(18, 16);
    const auto position = [&limb](double u, double v) { return limb.At(u == 1 ? 0 : u, v); };
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
      mesh.vertices[k] = (1e-3 * position(static_cast<double>(mesh.uv[k].x()),
                                          static_cast<double>(mesh.uv[k].y())))
                             .cast<float>();
    }
    ComputeNormals(&mesh);
    const auto paint = [&](double u, double v) {
      const Vector3d p = position(u, v);
      Paint result;
      result.label = Label::kHand;
      const double mottled = FractalNoise(0.09 * p, 3, 91), fine = Noise(0.7 * p, 92);
      result.colour = skin * (1 + 0.05 * mottled + 0.03 * fine);
      const double knuckle = std::exp(-std::pow((v - 0.3) / 0.1, 2));
      result.colour = result.colour.cwiseProduct(Srgb(1, 1 - 0.07 * knuckle, 1 - 0.08 * knuckle));
      result.height_mm = 0.1 * fine + 0.3 * mottled;
      result.gloss = 0.05;
      return result;
    };
    parts.push_back({"hand", std::move(mesh), BakeTexture({position, paint}, 32, 64)});
  }
  return parts;
}

}  // namespace visavis
