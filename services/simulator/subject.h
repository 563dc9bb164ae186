#pragma once

#include <string>
#include <vector>

#include "services/simulator/colour.h"
#include "services/simulator/head_shape.h"

namespace visavis {

/// Hair, or what covers it.
struct HairStyle {
  enum class Kind { kBald, kShort, kLong, kBeanie };
  Kind kind{Kind::kShort};
  Srgb colour{0.09, 0.07, 0.06};
  double grey{0.0};           ///< share of grey strands, 0 to 1
  double thickness_mm{9};     ///< how far it stands out on top
  double sides_mm{5};         ///< and at the temples
  double hairline_mm{0};      ///< hairline above the average one (receding)
  double temple_mm{4};        ///< further recession at the temples
  double raggedness_mm{2.5};  ///< amplitude of the hairline's irregularity
  double curl{0.0};           ///< 0 straight strands to 1 tight curls
  double parting{0.0};        ///< side to which the strands are combed, -1 to 1
  double beard{0.0};          ///< 0 none, 0.3 stubble, 1 full beard
};

/// The face's colours.
struct Complexion {
  Srgb skin{0.80, 0.62, 0.53};
  double redness{1.0};   ///< blood in cheeks, nose, ears, lips; 0 to 1.5
  double freckles{0.0};  ///< 0 to 1
  double age{0.3};       ///< wrinkles and mottling, 0 to 1
  Srgb lips{0.70, 0.46, 0.42};
  Srgb iris{0.30, 0.20, 0.13};
  Srgb brow{0.13, 0.10, 0.08};
  double brow_density{1.0};  ///< 0 none to 1.3 bushy
  double lashes{0.3};        ///< 0 light to 1.5 painted
  double brow_height_mm{0};  ///< brows above the average ones
};

/// Clothes on the shoulders.
struct Clothes {
  enum class Pattern { kPlain, kStripes, kChecks, kZip };
  Pattern pattern{Pattern::kPlain};
  Srgb colour{0.20, 0.30, 0.50};
  Srgb second{0.85, 0.85, 0.82};
  double shoulder_breadth_mm{460};  ///< over the upper arms
  double collar_mm{0};              ///< height of a standing collar
};

/// Everything that makes one simulated person.
struct Subject {
  std::string name;
  HeadMeasures shape;
  HairStyle hair;
  Complexion complexion;
  Clothes clothes;
  unsigned seed{1};  ///< of mottling, strands and folds

  /// @throws std::invalid_argument naming field, value and range.
  void ValidateOrThrow() const;
};

/// The built-in people, adult_a to adult_h: different shapes, skins, hair.
std::vector<std::string> SubjectNames();

/// One of SubjectNames(), or anybody_1, anybody_2, ...: somebody at random (Anybody).
/// @throws std::invalid_argument listing the names when there is none of that name.
Subject NamedSubject(const std::string& name);

}  // namespace visavis
