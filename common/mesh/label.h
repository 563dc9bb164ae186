#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace visavis {

/// What a rendered surface is. The values are those of the label pictures that the simulator
/// writes; 0 to 7 agree with the masks of the recorded sequences.
enum class Label : std::uint8_t {
  kBackground = 0,
  kSkin = 1,  ///< skin of the face and of the bare head
  kNeck = 2,
  kHair = 3,  ///< hair, or what covers it (cap)
  kClothes = 4,
  kEye = 5,  ///< visible part of the eyeball
  kBrow = 6,
  kLash = 7,  ///< lashes and the line of the upper lid
  kLips = 8,
  kNostril = 9,
  kEar = 10,
  kHand = 11,      ///< occluding hand
  kBystander = 12  ///< everything of a second person
};
inline constexpr int kNumLabels = 13;

/// True for what turns with the skull: all but background, neck, clothes, hand and bystander.
constexpr bool IsHead(Label label) {
  return label != Label::kBackground && label != Label::kNeck && label != Label::kClothes &&
         label != Label::kHand && label != Label::kBystander;
}

/// True for the face: skin, eyes, brows, lashes, lips, nostrils.
constexpr bool IsFace(Label label) {
  return IsHead(label) && label != Label::kHair && label != Label::kEar;
}

/// Label of a mesh part by its material's name, e.g. "Hair_short" or "skin.001": the first known
/// word found in it, case-insensitive. The more special come first: brow before eye ("eyebrow"),
/// nostril before skin, ear ("beard", "rear") last.
std::optional<Label> LabelFromMaterialName(std::string_view name);

}  // namespace visavis
