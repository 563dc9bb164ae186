#include "common/mesh/label.h"

#include <gtest/gtest.h>

namespace visavis {
namespace {

TEST(LabelTest, IsFoundInTheMaterialsName) {
  EXPECT_EQ(LabelFromMaterialName("Hair_short04"), Label::kHair);
  EXPECT_EQ(LabelFromMaterialName("young_lightSKINNED_male"), Label::kSkin);
  EXPECT_EQ(LabelFromMaterialName("eyebrow001"), Label::kBrow);
  EXPECT_EQ(LabelFromMaterialName("Eyelashes"), Label::kLash);
  EXPECT_EQ(LabelFromMaterialName("high-poly eyes"), Label::kEye);
  EXPECT_EQ(LabelFromMaterialName("full_beard"), Label::kHair);
  EXPECT_EQ(LabelFromMaterialName("ear.L"), Label::kEar);
  EXPECT_EQ(LabelFromMaterialName("T-Shirt"), Label::kClothes);
  EXPECT_EQ(LabelFromMaterialName("Material.003"), std::nullopt);
}

TEST(LabelTest, HeadIsWhatTurnsWithTheSkullAndFaceItsFront) {
  EXPECT_TRUE(IsHead(Label::kHair));
  EXPECT_FALSE(IsFace(Label::kHair));
  EXPECT_TRUE(IsFace(Label::kEye));
  for (const Label label :
       {Label::kBackground, Label::kNeck, Label::kClothes, Label::kHand, Label::kBystander}) {
    EXPECT_FALSE(IsHead(label));
    EXPECT_FALSE(IsFace(label));
  }
}

}  // namespace
}  // namespace visavis
