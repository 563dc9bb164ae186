#include "common/mesh/label.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <utility>

namespace visavis {

std::optional<Label> LabelFromMaterialName(std::string_view name) {
  // Order matters: eyebrow and eyelash contain eye, beard contains ear.
  static constexpr std::pair<std::string_view, Label> kWords[] = {
      {"brow", Label::kBrow},       {"lash", Label::kLash},     {"eye", Label::kEye},
      {"hair", Label::kHair},       {"beard", Label::kHair},    {"cap", Label::kHair},
      {"hat", Label::kHair},        {"cloth", Label::kClothes}, {"shirt", Label::kClothes},
      {"neck", Label::kNeck},       {"lip", Label::kLips},      {"mouth", Label::kLips},
      {"nostril", Label::kNostril}, {"skin", Label::kSkin},     {"face", Label::kSkin},
      {"head", Label::kSkin},       {"ear", Label::kEar}};
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [word, label] : kWords) {
    if (lower.find(word) != std::string::npos) return label;
  }
  return std::nullopt;
}

}  // namespace visavis
