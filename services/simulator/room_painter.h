#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/core/random.h"
#include "services/simulator/colour.h"

namespace visavis {

/// Paints a furnished wall into a picture, in metres from its middle (x right, y down).
class RoomPainter {
 public:
  RoomPainter(int width, int height, double m_per_pixel, std::uint64_t seed);

  /// Wall of the given colour with a bookcase, pictures, a plant, boxes, a cabinet, a screen; some
  /// of it has the colours of skin, some is dark, some is wood.
  void PaintRoom(const Srgb& wall);

  /// Pixels row by row, red in the low byte.
  std::vector<std::uint32_t> TakePicture();

 private:
  struct Box {
    double x0, y0, x1, y1;  ///< [m]
  };
  using Painter = std::function<Srgb(double x, double y)>;

  void Fill(const Box& box, const Painter& painter);
  void FillDisc(double x, double y, double rx, double ry, const Painter& painter);
  /// Darkens round a box, as a thing before a wall does.
  void Shadow(const Box& box, double reach_m, double strength);

  void Wall(const Srgb& colour);
  void Bookcase(const Box& box);
  void Books(const Box& shelf);
  void Landscape(const Box& box);
  void Portrait(const Box& box);
  void Pinboard(const Box& box);
  void Plant(double x, double y, double size);
  void Cabinet(const Box& box);
  void Screen(const Box& box);
  void Carton(const Box& box);
  void Clock(double x, double y, double radius);

  Srgb Wood(double along, double across, const Srgb& tone) const;
  Srgb RandomBookColour();

  int width_, height_;
  double m_per_pixel_;
  Random random_;
  std::uint32_t seed_;
  std::vector<std::uint32_t> picture_;
};

}  // namespace visavis
