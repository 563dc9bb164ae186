#include "services/simulator/anybody.h"

#include <algorithm>

#include "common/core/random.h"

namespace visavis {
namespace {

/// Draws what a person is made of.
class Draw {
 public:
  explicit Draw(std::uint64_t number) : random_(number) {
    for (int i = 0; i < 8; ++i) random_.Bits();
  }

  bool Chance(double share) { return random_.Uniform() < share; }
  double Between(double least, double most) { return random_.Uniform(least, most); }
  /// About @p mean, at most two standard deviations away.
  double About(double mean, double sigma) {
    return mean + sigma * std::clamp(random_.Normal(), -2.0, 2.0);
  }
  int One(int count) { return random_.Index(count); }
  Srgb Colour(const Srgb& from, const Srgb& to) { return MixColour(from, to, random_.Uniform()); }

 private:
  Random random_;
};

// Means and deviations of adults, women smaller by about one deviation in most.
HeadMeasures ShapeOf(Draw* draw, bool woman) {
  const double smaller = woman ? 1 : 0;
  HeadMeasures s;
  s.breadth_mm = draw->About(154 - 7 * smaller, 5);
  s.length_mm = draw->About(197 - 10 * smaller, 6.5);
  s.height_mm = draw->About(230 - 13 * smaller, 9);
  s.bizygomatic_mm = draw->About(139 - 9 * smaller, 5);
  s.bigonial_mm = draw->About(109 - 10 * smaller, 5.5);
  s.interpupillary_mm = draw->About(63 - 2 * smaller, 3);
  s.eye_opening_mm = draw->About(10 + 0.8 * smaller, 1.1);
  s.canthal_tilt_mm = draw->About(1.5, 1);
  s.lid_fold = draw->Between(0.2, 1);
  s.nose_length_mm = draw->About(51 - 3 * smaller, 3.5);
  s.nose_breadth_mm = draw->About(37 - 3 * smaller, 3.5);
  s.nose_protrusion_mm = draw->About(20 - 1.5 * smaller, 2.2);
  s.nose_bridge_mm = draw->About(0, 1.3);
  s.mouth_breadth_mm = draw->About(52 - 3 * smaller, 3.5);
  s.lip_fullness = draw->Between(0.6, 1.6);
  s.chin_mm = draw->About(0, 1.5);
  s.brow_ridge_mm = std::max(0.0, draw->About(1.8 - 1.4 * smaller, 0.8));
  s.cheek_mm = draw->About(0, 2);
  s.neck_breadth_mm = draw->About(116 - 17 * smaller, 7);
  s.ear_length_mm = draw->About(64 - 5 * smaller, 4);
  s.ear_flare_deg = draw->Between(10, 32);
  return s;
}

HairStyle HairOf(Draw* draw, bool woman, double age, bool dark) {
  HairStyle h;
  using Kind = HairStyle::Kind;
  h.kind = woman ? (draw->Chance(0.7) ? Kind::kLong : Kind::kShort)
                 : (draw->Chance(0.75) ? Kind::kShort : Kind::kBald);
  if (draw->Chance(0.08)) h.kind = Kind::kBeanie;
  const Srgb black(0.06, 0.05, 0.05), brown(0.30, 0.19, 0.11), fair(0.68, 0.54, 0.36);
  h.colour = dark ? draw->Colour(black, 1.4 * black)
                  : draw->Colour(black, draw->Chance(0.6) ? brown : fair);
  if (h.kind == Kind::kBeanie) h.colour = draw->Colour({0.15, 0.15, 0.2}, {0.6, 0.5, 0.5});
  h.grey = std::clamp(draw->About(1.4 * age - 0.6, 0.2), 0.0, 1.0);
  h.thickness_mm = h.kind == Kind::kLong ? draw->Between(9, 16) : draw->Between(4, 20);
  h.sides_mm = h.kind == Kind::kLong ? draw->Between(9, 15) : draw->Between(2, 8);
  const bool receding = !woman && draw->Chance(age);
  h.hairline_mm = receding ? draw->Between(4, 20) : draw->About(0, 3);
  h.temple_mm = receding ? draw->Between(5, 18) : woman ? draw->Between(0, 3) : draw->Between(2, 7);
  h.raggedness_mm = draw->Between(0.8, 3);
  h.curl = dark ? draw->Between(0.3, 1) : draw->Chance(0.3) ? draw->Between(0.1, 0.7) : 0.0;
  h.parting = draw->Between(-1, 1);
  h.beard = woman ? 0.0 : draw->Chance(0.3) ? draw->Between(0.5, 1) : draw->Between(0, 0.4);
  return h;
}

Complexion ComplexionOf(Draw* draw, bool woman, double age, double darkness) {
  Complexion c;
  const Srgb pale(0.92, 0.78, 0.71), light(0.80, 0.61, 0.51), brown(0.58, 0.40, 0.30),
      black(0.34, 0.21, 0.16);
  c.skin = darkness < 0.4   ? MixColour(pale, light, darkness / 0.4)
           : darkness < 0.7 ? MixColour(light, brown, (darkness - 0.4) / 0.3)
                            : MixColour(brown, black, (darkness - 0.7) / 0.3);
  c.redness = draw->Between(0.7, 1.4);
  c.freckles = darkness < 0.4 && draw->Chance(0.25) ? draw->Between(0.2, 1) : 0.0;
  c.age = age;
  const Srgb red = woman && draw->Chance(0.3) ? Srgb(0.62, 0.20, 0.22) : Srgb(0.72, 0.42, 0.38);
  c.lips = MixColour(c.skin, red, draw->Between(0.4, 0.8)) * (1 - 0.2 * darkness);
  const Srgb dark_iris(0.16, 0.10, 0.06), light_iris(0.40, 0.47, 0.52);
  c.iris = draw->Colour(dark_iris, darkness > 0.4 ? Srgb(0.3, 0.2, 0.12) : light_iris);
  c.brow = 0.8 * draw->Colour({0.07, 0.05, 0.045},
                              darkness > 0.4 ? Srgb(0.12, 0.09, 0.07) : Srgb(0.5, 0.37, 0.25));
  c.brow_density = draw->Between(0.5, 1.3);
  c.lashes = woman ? draw->Between(0.4, 1.4) : draw->Between(0.1, 0.5);
  c.brow_height_mm = draw->About(woman ? 1.3 : 0, 1.2);
  return c;
}

Clothes ClothesOf(Draw* draw, bool woman) {
  constexpr Clothes::Pattern kPatterns[] = {Clothes::Pattern::kPlain, Clothes::Pattern::kStripes,
                                            Clothes::Pattern::kChecks, Clothes::Pattern::kZip};
  Clothes c;
  c.pattern = kPatterns[draw->One(4)];
  c.colour = {draw->Between(0.1, 0.85), draw->Between(0.1, 0.85), draw->Between(0.1, 0.85)};
  c.second = {draw->Between(0.1, 0.85), draw->Between(0.1, 0.85), draw->Between(0.1, 0.85)};
  c.shoulder_breadth_mm = draw->About(woman ? 410 : 465, 18);
  c.collar_mm = draw->Chance(0.5) ? 0 : draw->Between(10, 30);
  return c;
}

}  // namespace

Subject Anybody(std::uint64_t number) {
  Draw draw(number);
  const bool woman = draw.Chance(0.5);
  const double age = draw.Between(0, 1), darkness = draw.Between(0, 1);
  Subject subject;
  subject.name = "anybody_" + std::to_string(number);
  subject.shape = ShapeOf(&draw, woman);
  subject.hair = HairOf(&draw, woman, age, darkness > 0.55);
  subject.complexion = ComplexionOf(&draw, woman, age, darkness);
  subject.clothes = ClothesOf(&draw, woman);
  subject.seed = static_cast<unsigned>(number);
  subject.ValidateOrThrow();
  return subject;
}

}  // namespace visavis
