#include "services/simulator/subject.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "common/core/check.h"
#include "services/simulator/anybody.h"

namespace visavis {
namespace {

bool IsColour(const Srgb& colour) {
  return colour.allFinite() && (colour.array() >= 0).all() && (colour.array() <= 1).all();
}

Subject AdultA() {
  Subject s;
  s.shape.breadth_mm = 154;
  s.shape.height_mm = 229;
  s.shape.nose_protrusion_mm = 21;
  s.shape.brow_ridge_mm = 2.2;
  s.shape.chin_mm = 1;
  s.hair.colour = {0.085, 0.07, 0.06};
  s.hair.thickness_mm = 13;
  s.hair.sides_mm = 6;
  s.hair.parting = 0.5;
  s.hair.beard = 0.22;
  s.complexion.skin = {0.82, 0.64, 0.54};
  s.clothes.colour = {0.16, 0.27, 0.47};
  s.seed = 101;
  return s;
}

Subject AdultB() {
  Subject s;
  s.shape = {146, 184, 217, 128,  97, 60,  11.0, 2.0, 1.0, 48, 32,
             18,  -1,  48,  1.15, -1, 0.2, 1.5,  98,  58,  12};
  s.hair.kind = HairStyle::Kind::kLong;
  s.hair.colour = {0.27, 0.17, 0.10};
  s.hair.thickness_mm = 13;
  s.hair.sides_mm = 13;
  s.hair.temple_mm = 0;
  s.hair.parting = 0.2;
  s.complexion.skin = {0.87, 0.70, 0.62};
  s.complexion.freckles = 0.7;
  s.complexion.lashes = 1;
  s.complexion.age = 0.1;
  s.complexion.lips = {0.70, 0.40, 0.40};
  s.complexion.iris = {0.32, 0.36, 0.26};
  s.complexion.brow = {0.22, 0.14, 0.09};
  s.complexion.brow_density = 0.8;
  s.complexion.brow_height_mm = 2;
  s.clothes = {Clothes::Pattern::kStripes, {0.82, 0.80, 0.76}, {0.18, 0.22, 0.34}, 405, 0};
  s.seed = 202;
  return s;
}

Subject AdultC() {
  Subject s;
  s.shape = {151,  198, 231, 140,  108, 64,  10.2, 1.0, 0.7, 49, 43,
             17.5, -2,  55,  1.55, 0,   1.8, 0,    118, 60,  20};
  s.hair.colour = {0.05, 0.04, 0.04};
  s.hair.thickness_mm = 7;
  s.hair.sides_mm = 4;
  s.hair.curl = 1;
  s.hair.temple_mm = 6;
  s.hair.raggedness_mm = 1.0;
  s.hair.beard = 0.2;
  s.complexion.skin = {0.37, 0.235, 0.175};
  s.complexion.redness = 0.8;
  s.complexion.lips = {0.40, 0.24, 0.21};
  s.complexion.iris = {0.17, 0.10, 0.06};
  s.complexion.brow = {0.05, 0.04, 0.04};
  s.clothes = {Clothes::Pattern::kZip, {0.50, 0.52, 0.53}, {0.2, 0.2, 0.2}, 480, 22};
  s.seed = 303;
  return s;
}

Subject AdultD() {
  Subject s;
  s.shape = {157, 200, 234, 141, 112, 63,  9.0, 0.5, 0.8, 54, 37,
             21,  1,   53,  0.8, 1,   2.5, 1.5, 124, 67,  27};
  s.hair.kind = HairStyle::Kind::kBald;
  s.hair.colour = {0.22, 0.18, 0.15};
  s.hair.grey = 0.3;
  s.hair.beard = 0.42;
  s.complexion.skin = {0.80, 0.60, 0.50};
  s.complexion.redness = 1.3;
  s.complexion.age = 0.6;
  s.complexion.lips = {0.62, 0.42, 0.38};
  s.complexion.iris = {0.30, 0.38, 0.45};
  s.complexion.brow = {0.25, 0.19, 0.14};
  s.clothes = {Clothes::Pattern::kChecks, {0.62, 0.20, 0.17}, {0.12, 0.13, 0.18}, 490, 18};
  s.seed = 404;
  return s;
}

Subject AdultE() {
  Subject s;
  s.shape = {144, 181,  213, 126, 96, 59, 11.5, 2.0, 1.0, 46, 31,
             17,  -1.5, 47,  1.0, -1, 0,  2.5,  95,  56,  12};
  s.hair.kind = HairStyle::Kind::kLong;
  s.hair.colour = {0.66, 0.52, 0.34};
  s.hair.thickness_mm = 12;
  s.hair.sides_mm = 12;
  s.hair.temple_mm = 0;
  s.hair.parting = -0.3;
  s.complexion.skin = {0.91, 0.76, 0.69};
  s.complexion.redness = 1.2;
  s.complexion.freckles = 0.25;
  s.complexion.lashes = 1;
  s.complexion.age = 0.1;
  s.complexion.lips = {0.76, 0.47, 0.46};
  s.complexion.iris = {0.36, 0.46, 0.55};
  s.complexion.brow = {0.46, 0.34, 0.22};
  s.complexion.brow_density = 0.7;
  s.complexion.brow_height_mm = 1.5;
  s.clothes = {Clothes::Pattern::kPlain, {0.35, 0.14, 0.22}, {0.8, 0.8, 0.8}, 400, 0};
  s.seed = 505;
  return s;
}

Subject AdultF() {
  Subject s;
  s.shape = {153, 196, 227, 136,  105, 62,  8.6, 0.2, 0.5, 55, 38,
             22,  1.5, 50,  0.65, 0.5, 2.0, -3,  110, 70,  30};
  s.hair.colour = {0.42, 0.41, 0.40};
  s.hair.grey = 0.7;
  s.hair.thickness_mm = 8;
  s.hair.sides_mm = 7;
  s.hair.hairline_mm = 14;
  s.hair.temple_mm = 16;
  s.hair.parting = 0.8;
  s.complexion.skin = {0.81, 0.62, 0.53};
  s.complexion.redness = 1.25;
  s.complexion.age = 1;
  s.complexion.lips = {0.62, 0.43, 0.40};
  s.complexion.iris = {0.33, 0.35, 0.36};
  s.complexion.brow = {0.42, 0.38, 0.35};
  s.complexion.brow_density = 0.95;
  s.clothes = {Clothes::Pattern::kPlain, {0.28, 0.33, 0.25}, {0.8, 0.8, 0.8}, 455, 25};
  s.seed = 606;
  return s;
}

Subject AdultG() {
  Subject s;
  s.shape = {150, 192, 224, 135, 104, 61.5, 9.8, 1.2, 0.9, 52, 37,
             22,  2,   50,  1.1, 0,   2.0,  -1,  112, 62,  20};
  s.hair.kind = HairStyle::Kind::kBeanie;
  s.hair.colour = {0.34, 0.36, 0.40};
  s.hair.thickness_mm = 9;
  s.hair.sides_mm = 8;
  s.complexion.skin = {0.63, 0.44, 0.33};
  s.complexion.lips = {0.52, 0.32, 0.28};
  s.complexion.iris = {0.22, 0.14, 0.09};
  s.complexion.brow = {0.08, 0.06, 0.05};
  s.complexion.brow_density = 1.25;
  s.clothes = {Clothes::Pattern::kZip, {0.75, 0.55, 0.16}, {0.2, 0.2, 0.2}, 465, 30};
  s.seed = 707;
  return s;
}

Subject AdultH() {
  Subject s;
  s.shape = {148, 187,  218, 131, 99,   61,  11.0, 1.8, 0.9, 47, 38,
             17,  -1.5, 52,  1.4, -0.5, 0.3, 1.5,  100, 57,  12};
  s.hair.kind = HairStyle::Kind::kLong;
  s.hair.colour = {0.075, 0.055, 0.05};
  s.hair.curl = 0.45;
  s.hair.thickness_mm = 13;
  s.hair.sides_mm = 13;
  s.hair.temple_mm = 1;
  s.complexion.skin = {0.54, 0.36, 0.27};
  s.complexion.redness = 0.9;
  s.complexion.lashes = 1;
  s.complexion.age = 0.15;
  s.complexion.lips = {0.52, 0.27, 0.26};
  s.complexion.iris = {0.19, 0.11, 0.07};
  s.complexion.brow = {0.07, 0.05, 0.045};
  s.complexion.brow_height_mm = 1;
  s.clothes = {Clothes::Pattern::kPlain, {0.20, 0.42, 0.40}, {0.8, 0.8, 0.8}, 410, 0};
  s.seed = 808;
  return s;
}

struct Entry {
  const char* name;
  Subject (*make)();
};
constexpr Entry kSubjects[] = {{"adult_a", AdultA}, {"adult_b", AdultB}, {"adult_c", AdultC},
                               {"adult_d", AdultD}, {"adult_e", AdultE}, {"adult_f", AdultF},
                               {"adult_g", AdultG}, {"adult_h", AdultH}};

constexpr const char* kAnybody = "anybody_";
constexpr std::size_t kMostDigits = 9;

}  // namespace

void Subject::ValidateOrThrow() const {
  shape.ValidateOrThrow();
  for (const Srgb& colour : {hair.colour, complexion.skin, complexion.lips, complexion.iris,
                             complexion.brow, clothes.colour, clothes.second}) {
    VISAVIS_THROW_UNLESS(IsColour(colour), colour.transpose());
  }
  VISAVIS_THROW_UNLESS(hair.thickness_mm >= 0 && hair.thickness_mm <= 40, hair.thickness_mm);
  VISAVIS_THROW_UNLESS(hair.sides_mm >= 0 && hair.sides_mm <= 40, hair.sides_mm);
  VISAVIS_THROW_UNLESS(hair.grey >= 0 && hair.grey <= 1, hair.grey);
  VISAVIS_THROW_UNLESS(hair.curl >= 0 && hair.curl <= 1, hair.curl);
  VISAVIS_THROW_UNLESS(hair.beard >= 0 && hair.beard <= 1, hair.beard);
  VISAVIS_THROW_UNLESS(complexion.age >= 0 && complexion.age <= 1, complexion.age);
  VISAVIS_THROW_UNLESS(clothes.shoulder_breadth_mm >= 250 && clothes.shoulder_breadth_mm <= 650,
                       clothes.shoulder_breadth_mm);
}

std::vector<std::string> SubjectNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kSubjects) names.emplace_back(entry.name);
  return names;
}

Subject NamedSubject(const std::string& name) {
  std::string known;
  for (const Entry& entry : kSubjects) {
    if (name == entry.name) {
      Subject subject = entry.make();
      subject.name = name;
      return subject;
    }
    known += std::string(entry.name) + ", ";
  }
  const std::string digits = name.substr(std::min(name.size(), std::strlen(kAnybody)));
  if (name.rfind(kAnybody, 0) == 0 && !digits.empty() && digits.size() <= kMostDigits &&
      digits.find_first_not_of("0123456789") == std::string::npos) {
    return Anybody(std::stoull(digits));
  }
  throw std::invalid_argument("subject = " + name + ": must be one of " + known +
                              "or anybody_1, anybody_2, ...");
}

}  // namespace visavis
