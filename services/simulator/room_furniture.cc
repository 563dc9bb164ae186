#include <algorithm>
#include <cmath>

#include "services/simulator/procedural_noise.h"
#include "services/simulator/room_painter.h"

namespace visavis {

void RoomPainter::Landscape(const Box& box) {
  Shadow(box, 0.05, 0.35);
  Fill(box, [](double, double) { return Srgb(0.12, 0.11, 0.11); });
  constexpr double kFrame = 0.025;
  const Box inside{box.x0 + kFrame, box.y0 + kFrame, box.x1 - kFrame, box.y1 - kFrame};
  Fill(inside, [&](double x, double y) {
    const double down = (y - inside.y0) / (inside.y1 - inside.y0);
    const double far = 0.46 + 0.10 * FractalNoise({5 * x, 1, 0}, 4, seed_ + 11);
    const double near = 0.66 + 0.12 * FractalNoise({3 * x, 2, 0}, 4, seed_ + 12);
    const double texture = FractalNoise({30 * x, 60 * y, 3}, 4, seed_ + 13);
    if (down < far) {
      const double cloud = SmoothStep(0.0, 0.7, FractalNoise({6 * x, 14 * y, 4}, 4, seed_ + 14));
      return MixColour(Srgb(0.35 + 0.4 * down, 0.52 + 0.3 * down, 0.80), Srgb(0.92, 0.88, 0.84),
                       cloud);
    }
    if (down < near) return Srgb(Srgb(0.33, 0.36, 0.42) * (1 + 0.25 * texture));
    return Srgb(Srgb(0.30, 0.36, 0.14) * (1 + 0.5 * texture));
  });
}

void RoomPainter::Portrait(const Box& box) {
  // Blobs in the colours of skin and hair: what a colour rule takes for a head.
  Shadow(box, 0.04, 0.35);
  Fill(box, [&](double x, double y) { return Wood(y, x, {0.42, 0.27, 0.16}); });
  constexpr double kFrame = 0.03;
  const Box inside{box.x0 + kFrame, box.y0 + kFrame, box.x1 - kFrame, box.y1 - kFrame};
  const double cx = 0.5 * (box.x0 + box.x1), cy = 0.5 * (box.y0 + box.y1);
  Fill(inside, [&](double x, double y) {
    const double brush = FractalNoise({40 * x, 90 * y, 5}, 3, seed_ + 15);
    const double face = std::hypot((x - cx) / 0.062, (y - cy - 0.01) / 0.082) + 0.06 * brush;
    const double hair = std::hypot((x - cx) / 0.078, (y - cy + 0.028) / 0.085) + 0.05 * brush;
    if (face < 1 && y > cy - 0.04)
      return Srgb(Srgb(0.78, 0.56, 0.44) * (1 + 0.12 * brush - 0.1 * face));
    if (hair < 1) return Srgb(Srgb(0.16, 0.11, 0.08) * (1 + 0.4 * brush));
    if (y > cy + 0.09) return Srgb(Srgb(0.45, 0.16, 0.12) * (1 + 0.3 * brush));
    return Srgb(Srgb(0.30, 0.34, 0.30) * (1 + 0.3 * brush));
  });
}

void RoomPainter::Pinboard(const Box& box) {
  Shadow(box, 0.04, 0.3);
  Fill(box, [&](double x, double y) {
    return Srgb(Srgb(0.70, 0.53, 0.36) * (1 + 0.16 * Noise({260 * x, 260 * y, 6}, seed_ + 16)));
  });
  for (int k = 0; k < 11; ++k) {
    const double x = random_.Uniform(box.x0 + 0.02, box.x1 - 0.18),
                 y = random_.Uniform(box.y0 + 0.02, box.y1 - 0.18);
    const double w = random_.Uniform(0.06, 0.15), h = random_.Uniform(0.06, 0.16);
    const Srgb paper = random_.Uniform() < 0.6 ? Srgb(0.90, 0.89, 0.85) : RandomBookColour();
    Fill({x, y, x + w, y + h}, [&](double px, double py) {
      const bool line =
          std::fmod(py - y, 0.012) < 0.004 && Noise({150 * px, 40 * py, 7}, seed_ + 17) > -0.2;
      const bool margin = px < x + 0.1 * w || px > x + 0.9 * w || py < y + 0.1 * h;
      return Srgb(paper * (line && !margin ? 0.55 : 1.0));
    });
  }
}

void RoomPainter::Plant(double x, double y, double size) {
  const double pot = 0.42 * size;
  Fill({x - 0.5 * pot, y, x + 0.5 * pot, y + pot}, [&](double px, double py) {
    const double round = (px - x) / pot;
    return Srgb(Srgb(0.66, 0.36, 0.24) * (1.05 - 1.6 * round * round - 0.2 * (py - y)));
  });
  for (int k = 0; k < 70; ++k) {
    const double angle = random_.Uniform(-2.6, -0.5), reach = size * random_.Uniform(0.25, 1.0);
    const double lx = x + 0.9 * reach * std::cos(angle), ly = y + reach * std::sin(angle);
    const double length = size * random_.Uniform(0.10, 0.20), lean = random_.Uniform(-1.2, 1.2);
    const double shade = random_.Uniform(0.45, 1.1);
    const double c = std::cos(lean), s = std::sin(lean), r = 1.1 * length;
    const auto inside = [&](double px, double py, double* rib) {
      const double a = (c * (px - lx) + s * (py - ly)) / length,
                   b = (-s * (px - lx) + c * (py - ly)) / (0.38 * length);
      *rib = std::abs(b);
      return a * a + std::abs(b) < 1 - 0.3 * a;
    };
    const int cells = static_cast<int>(r / m_per_pixel_);
    for (int j = -cells; j <= cells; ++j) {
      for (int i = -cells; i <= cells; ++i) {
        const double px = lx + i * m_per_pixel_, py = ly + j * m_per_pixel_;
        double rib = 0;
        if (!inside(px, py, &rib)) continue;
        Fill({px, py, px + m_per_pixel_, py + m_per_pixel_}, [&](double, double) {
          return Srgb(Srgb(0.22, 0.44, 0.17) * shade * (rib < 0.12 ? 1.35 : 1 - 0.25 * rib));
        });
      }
    }
  }
}

void RoomPainter::Cabinet(const Box& box) {
  const Srgb tone(0.62, 0.44, 0.29);
  Shadow(box, 0.06, 0.3);
  Fill(box, [&](double x, double y) { return Wood(y, x, tone); });
  Fill({box.x0 - 0.01, box.y0, box.x1 + 0.01, box.y0 + 0.03},
       [&](double x, double y) { return Srgb(Wood(x, y, tone) * 1.1); });
  constexpr int kDoors = 4;
  const double w = (box.x1 - box.x0) / kDoors;
  for (int i = 0; i < kDoors; ++i) {
    const Box door{box.x0 + i * w + 0.012, box.y0 + 0.05, box.x0 + (i + 1) * w - 0.012, box.y1};
    Fill(door, [&](double x, double y) {
      const double edge = std::min({x - door.x0, door.x1 - x, y - door.y0});
      return Srgb(Wood(y + 3.0 * i, x, tone) * (edge < 0.006 ? 0.6 : edge < 0.05 ? 1.06 : 0.94));
    });
    FillDisc(door.x1 - 0.03, door.y0 + 0.2, 0.010, 0.010,
             [](double, double) { return Srgb(0.75, 0.73, 0.68); });
  }
}

void RoomPainter::Screen(const Box& box) {
  Shadow(box, 0.05, 0.3);
  Fill({box.x0 + 0.22, box.y1, box.x1 - 0.22, box.y1 + 0.03},
       [](double, double) { return Srgb(0.12, 0.12, 0.13); });
  Fill(box, [](double, double) { return Srgb(0.07, 0.07, 0.08); });
  Fill({box.x0 + 0.015, box.y0 + 0.015, box.x1 - 0.015, box.y1 - 0.02}, [&](double x, double y) {
    const double glare = SmoothStep(0.5, -0.1, (x - box.x0) + 0.8 * (y - box.y0));
    const bool text =
        std::fmod(y - box.y0, 0.022) < 0.008 &&
        Noise({60 * x, 90 * std::floor((y - box.y0) / 0.022), 8}, seed_ + 18) > 0.05 &&
        x < box.x0 + 0.4;
    return Srgb(Srgb(0.13, 0.16, 0.21) + Srgb::Constant(0.16 * glare + (text ? 0.28 : 0)));
  });
}

void RoomPainter::Carton(const Box& box) {
  Shadow(box, 0.03, 0.25);
  Fill(box, [&](double x, double y) {
    const double flute = 0.03 * std::sin(2 * M_PI * x / 0.008),
                 stain = 0.06 * Noise({7 * x, 7 * y, 9}, seed_ + 19);
    const double middle = std::abs(x - 0.5 * (box.x0 + box.x1));
    Srgb colour = Srgb(0.69, 0.53, 0.36) * (0.96 + flute + stain);
    if (middle < 0.025) colour = MixColour(colour, Srgb(0.80, 0.70, 0.52), 0.6);
    if (y < box.y0 + 0.006) colour *= 0.7;
    return colour;
  });
}

void RoomPainter::Clock(double x, double y, double radius) {
  Shadow({x - 0.6 * radius, y - 0.6 * radius, x + 0.6 * radius, y + 0.6 * radius}, 0.6 * radius,
         0.3);
  FillDisc(x, y, radius, radius, [](double, double) { return Srgb(0.16, 0.15, 0.15); });
  FillDisc(x, y, 0.9 * radius, 0.9 * radius, [&](double px, double py) {
    const double r = std::hypot(px - x, py - y) / radius, angle = std::atan2(px - x, y - py);
    const double hour = std::abs(std::remainder(angle, M_PI / 6)) * r;
    const double hand = std::abs(std::remainder(angle - 5.3, 2 * M_PI)) * r,
                 minute = std::abs(std::remainder(angle - 1.0, 2 * M_PI)) * r;
    const bool dark = (r > 0.72 && r < 0.84 && hour < 0.03) || (r < 0.45 && hand < 0.04) ||
                      (r < 0.7 && minute < 0.025);
    return dark ? Srgb(0.1, 0.1, 0.1) : Srgb(0.92, 0.91, 0.88);
  });
}

}  // namespace visavis
