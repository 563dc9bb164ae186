#include "services/simulator/room_painter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

std::uint32_t Pack(const Srgb& colour) {
  const auto byte = [](double x) {
    return static_cast<std::uint32_t>(255 * std::clamp(x, 0.0, 1.0) + 0.5);
  };
  return byte(colour.x()) | byte(colour.y()) << 8 | byte(colour.z()) << 16;
}

Srgb Unpack(std::uint32_t rgb) {
  return Srgb(rgb & 255, (rgb >> 8) & 255, (rgb >> 16) & 255) / 255.0;
}

}  // namespace

RoomPainter::RoomPainter(int width, int height, double m_per_pixel, std::uint64_t seed)
    : width_(width),
      height_(height),
      m_per_pixel_(m_per_pixel),
      random_(seed),
      seed_(static_cast<std::uint32_t>(seed)),
      picture_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

std::vector<std::uint32_t> RoomPainter::TakePicture() { return std::move(picture_); }

void RoomPainter::Fill(const Box& box, const Painter& painter) {
  const auto column = [this](double x) {
    return static_cast<int>(std::lround(x / m_per_pixel_)) + width_ / 2;
  };
  const auto row = [this](double y) {
    return static_cast<int>(std::lround(y / m_per_pixel_)) + height_ / 2;
  };
  for (int j = std::max(row(box.y0), 0); j < std::min(row(box.y1), height_); ++j) {
    for (int i = std::max(column(box.x0), 0); i < std::min(column(box.x1), width_); ++i) {
      picture_[static_cast<std::size_t>(j * width_ + i)] = Pack(
          painter((i - width_ / 2 + 0.5) * m_per_pixel_, (j - height_ / 2 + 0.5) * m_per_pixel_));
    }
  }
}

void RoomPainter::FillDisc(double x, double y, double rx, double ry, const Painter& painter) {
  const int rows = static_cast<int>(std::ceil(ry / m_per_pixel_));
  for (int j = -rows; j <= rows; ++j) {
    const double yj = j * m_per_pixel_, inside = 1 - yj * yj / (ry * ry);
    if (inside <= 0) continue;
    const double half = rx * std::sqrt(inside);
    Fill({x - half, y + yj, x + half, y + yj + m_per_pixel_}, painter);
  }
}

void RoomPainter::Shadow(const Box& box, double reach_m, double strength) {
  const double s = strength;
  const Box around{box.x0 - reach_m, box.y0 - reach_m, box.x1 + 1.5 * reach_m,
                   box.y1 + 1.5 * reach_m};
  const auto at = [&](double x, double y) {
    const int i =
        std::clamp(static_cast<int>(std::floor(x / m_per_pixel_)) + width_ / 2, 0, width_ - 1);
    const int j =
        std::clamp(static_cast<int>(std::floor(y / m_per_pixel_)) + height_ / 2, 0, height_ - 1);
    return Unpack(picture_[static_cast<std::size_t>(j * width_ + i)]);
  };
  Fill(around, [&](double x, double y) {
    const double dx = std::max({box.x0 + 0.01 - x, x - box.x1 - 0.02, 0.0});
    const double dy = std::max({box.y0 + 0.01 - y, y - box.y1 - 0.02, 0.0});
    return Srgb(at(x, y) * (1 - s * SmoothStep(reach_m, 0, std::hypot(dx, dy))));
  });
}

Srgb RoomPainter::Wood(double along, double across, const Srgb& tone) const {
  const double warp = 0.06 * Noise({1.5 * along, 6 * across, 1}, seed_ + 1);
  const double rings = std::sin(2 * M_PI * (9 * (across + warp) + 0.4 * along));
  const double grain = Noise({6 * along, 160 * across, 2}, seed_ + 2);
  return tone * (0.92 + 0.07 * rings + 0.06 * grain);
}

void RoomPainter::Wall(const Srgb& colour) {
  const double half_x = 0.5 * width_ * m_per_pixel_, half_y = 0.5 * height_ * m_per_pixel_;
  Fill({-half_x, -half_y, half_x, half_y}, [&](double x, double y) {
    const double rough = Noise({90 * x, 90 * y, 0}, seed_ + 3),
                 wide = Noise({0.9 * x, 0.9 * y, 5}, seed_ + 4);
    return Srgb(colour * (1.0 - 0.10 * (y + half_y) / (2 * half_y) + 0.012 * rough + 0.035 * wide));
  });
}

Srgb RoomPainter::RandomBookColour() {
  static const Srgb kColours[] = {{0.16, 0.28, 0.52}, {0.55, 0.13, 0.14}, {0.14, 0.36, 0.25},
                                  {0.80, 0.70, 0.48}, {0.13, 0.13, 0.16}, {0.84, 0.83, 0.78},
                                  {0.68, 0.45, 0.20}, {0.47, 0.26, 0.42}, {0.72, 0.52, 0.42},
                                  {0.30, 0.50, 0.58}, {0.86, 0.64, 0.16}, {0.36, 0.22, 0.15}};
  const Srgb base = kColours[random_.Index(12)];
  return base * random_.Uniform(0.8, 1.15);
}

void RoomPainter::Books(const Box& shelf) {
  double x = shelf.x0 + random_.Uniform(0.0, 0.03);
  while (x < shelf.x1 - 0.05) {
    const double width = random_.Uniform(0.014, 0.050),
                 height = random_.Uniform(0.60, 0.94) * (shelf.y1 - shelf.y0);
    if (random_.Uniform() < 0.10) {
      x += random_.Uniform(0.03, 0.12);
      continue;
    }
    const Srgb cover = RandomBookColour(), band = RandomBookColour();
    const double label_at = random_.Uniform(0.15, 0.4), label_high = random_.Uniform(0.06, 0.3);
    const double top = shelf.y1 - height;
    const bool lettered = random_.Uniform() < 0.8;
    Fill({x, top, std::min(x + width, shelf.x1), shelf.y1}, [&](double px, double py) {
      const double round = (px - x) / width - 0.5, down = (py - top) / height;
      Srgb colour = cover * (1.02 - 1.1 * round * round);
      if (down > label_at && down < label_at + label_high) {
        colour = MixColour(colour, band * (1 - round * round), 0.8);
        if (lettered && Noise({400 * px, 60 * py, 3}, seed_) > 0.25) colour *= 0.55;
      }
      return Srgb(colour * (1 - 0.35 * SmoothStep(0.05, 0.0, py - shelf.y0)));
    });
    x += width + random_.Uniform(0.0, 0.003);
  }
}

void RoomPainter::Bookcase(const Box& box) {
  const Srgb tone(0.55, 0.38, 0.24);
  Shadow(box, 0.10, 0.35);
  Fill(box, [&](double x, double y) { return Wood(y, x, tone); });
  constexpr double kBoard = 0.022;
  const int shelves = 5, bays = 2;
  for (int j = 0; j < shelves; ++j) {
    for (int i = 0; i < bays; ++i) {
      const double w = (box.x1 - box.x0 - kBoard) / bays, h = (box.y1 - box.y0 - kBoard) / shelves;
      const Box inside{box.x0 + kBoard + i * w, box.y0 + kBoard + j * h, box.x0 + (i + 1) * w,
                       box.y0 + (j + 1) * h};
      Fill(inside, [&](double x, double y) {
        const double depth =
            SmoothStep(0, 0.06, x - inside.x0) * SmoothStep(0, 0.05, y - inside.y0);
        return Srgb(Wood(x, y, tone) * (0.30 + 0.22 * depth));
      });
      if (random_.Uniform() < 0.85) {
        Books({inside.x0, inside.y0, inside.x1 - random_.Uniform(0, 0.15), inside.y1});
      } else {
        Carton({inside.x0 + 0.05, inside.y1 - 0.6 * h, inside.x1 - 0.08, inside.y1});
      }
    }
  }
}

void RoomPainter::PaintRoom(const Srgb& wall) {
  Wall(wall);
  Bookcase({-1.48, -0.95, -0.42, 1.28});
  Landscape({0.42, -0.78, 1.12, -0.30});
  Portrait({1.30, -0.66, 1.62, -0.24});
  Pinboard({-2.35, -0.62, -1.72, -0.10});
  Clock(0.02, -0.86, 0.14);
  Cabinet({0.30, 0.48, 1.75, 1.28});
  Screen({0.98, 0.05, 1.56, 0.46});
  Carton({0.45, 0.18, 0.83, 0.48});
  const Box stool{-0.28, 0.66, 0.04, 1.28};
  Shadow(stool, 0.05, 0.3);
  Fill(stool, [&](double x, double y) {
    return Srgb(Wood(y, x, {0.50, 0.34, 0.22}) * (y < stool.y0 + 0.03 ? 1.15 : 0.9));
  });
  Plant(-0.12, 0.48, 0.42);
  Plant(2.05, 0.30, 0.50);
}

}  // namespace visavis
