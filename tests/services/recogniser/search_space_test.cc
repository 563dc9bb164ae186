#include "services/recogniser/search_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/config_reader.h"
#include "tests/support/config_refusal.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

SearchSpace SpaceOf(const std::string& preset) {
  SearchSpaceConfig config;
  config.preset = preset;
  return SearchSpace::FromConfig(config);
}

TEST(SearchSpaceTest, ThePapersPresetIsThePublishedBox) {
  const SearchSpace space = SpaceOf("paper");
  EXPECT_TRUE(space.min.isApprox(PhiOf(-100, -100, 900, -20, -20, -20)));
  EXPECT_TRUE(space.max.isApprox(PhiOf(100, 100, 1200, 20, 20, 20)));
}

TEST(SearchSpaceTest, TheWidePresetHoldsAShuttleOf150Mm) {
  const SearchSpace space = SpaceOf("wide");
  EXPECT_TRUE(space.min.isApprox(PhiOf(-200, -200, 900, -20, -20, -20)));
  EXPECT_TRUE(space.max.isApprox(PhiOf(200, 200, 1200, 20, 20, 20)));
}

TEST(SearchSpaceTest, PresetsDoNotHeedTheCustomKeys) {
  for (const std::string preset : {"paper", "wide"}) {
    SearchSpaceConfig config;
    config.preset = preset;
    config.min_x_mm = -1, config.max_z_mm = 4000, config.max_angle_deg = 70;
    EXPECT_EQ(SearchSpace::FromConfig(config).min, SpaceOf(preset).min);
    EXPECT_EQ(SearchSpace::FromConfig(config).max, SpaceOf(preset).max);
  }
}

TEST(SearchSpaceTest, ACustomSpaceIsItsKeys) {
  SearchSpaceConfig config;
  config.preset = "custom";
  config.min_x_mm = -10, config.max_x_mm = 20;
  config.min_y_mm = -30, config.max_y_mm = 40;
  config.min_z_mm = 500, config.max_z_mm = 600;
  config.max_angle_deg = 15;
  const SearchSpace space = SearchSpace::FromConfig(config);
  EXPECT_TRUE(space.min.isApprox(PhiOf(-10, -30, 500, -15, -15, -15)));
  EXPECT_TRUE(space.max.isApprox(PhiOf(20, 40, 600, 15, 15, 15)));
  EXPECT_TRUE(space.range().isApprox(PhiOf(30, 70, 100, 30, 30, 30)));
}

TEST(SearchSpaceTest, AnAxisMayHaveARangeOfItsOwn) {
  SearchSpaceConfig config;
  config.preset = "custom";
  config.max_angle_deg = 15;
  config.max_theta_deg = 60;
  config.max_psi_deg = 40;
  const SearchSpace space = SearchSpace::FromConfig(config);
  EXPECT_TRUE(space.min.tail<3>().isApprox(PhiOf(0, 0, 0, -15, -60, -40).tail<3>()));
  EXPECT_TRUE(space.max.tail<3>().isApprox(PhiOf(0, 0, 0, 15, 60, 40).tail<3>()));
  config.preset = "wide";
  EXPECT_EQ(SearchSpace::FromConfig(config).max, SpaceOf("wide").max);
}

TEST(SearchSpaceTest, TheBorderIsAShareOfEachRangeAndAllBeyond) {
  const SearchSpace space = SpaceOf("paper");  // 5 %: 10 mm of t_x, 15 mm of t_z, 2 deg
  EXPECT_FALSE(space.AtBorder(PhiOf(-89, 89, 916, 17.9, -17.9, 17.9), 0.05));
  EXPECT_TRUE(space.AtBorder(PhiOf(-91, 0, 1000, 0, 0, 0), 0.05));
  EXPECT_TRUE(space.AtBorder(PhiOf(0, 0, 1186, 0, 0, 0), 0.05));
  EXPECT_TRUE(space.AtBorder(PhiOf(0, 0, 1000, 0, 0, -18.1), 0.05));
  EXPECT_TRUE(space.AtBorder(PhiOf(0, 300, 1000, 0, 0, 0), 0.05));
  EXPECT_FALSE(space.AtBorder(PhiOf(99.9, 0, 1000, 0, 0, 0), 0));
}

TEST(SearchSpaceTest, WideFollowsTheHeadPaperDoesNotAndCustomAsItSays) {
  SearchSpaceConfig config;
  for (const bool recentre : {false, true}) {
    config.recentre = recentre;
    config.preset = "wide";
    EXPECT_TRUE(Recentres(config));
    config.preset = "paper";
    EXPECT_FALSE(Recentres(config));
    config.preset = "custom";
    EXPECT_EQ(Recentres(config), recentre);
  }
}

TEST(SearchSpaceTest, ClampMovesOnlyWhatLiesOutside) {
  const SearchSpace space = SpaceOf("paper");
  const Vector6d inside = PhiOf(10, -20, 1000, 5, -6, 7);
  EXPECT_TRUE(space.Contains(inside));
  EXPECT_EQ(space.Clamp(inside), inside);
  const Vector6d outside = PhiOf(110, -120, 1300, 5, -26, 7);
  EXPECT_FALSE(space.Contains(outside));
  EXPECT_TRUE(space.Clamp(outside).isApprox(PhiOf(100, -100, 1200, 5, -20, 7)));
  EXPECT_TRUE(space.Contains(space.Clamp(outside)));
}

TEST(SearchSpaceTest, CentredOnAHeadKeepsExtentAndAngles) {
  const SearchSpace space = SpaceOf("wide");
  const SearchSpace moved = space.CentredOn({0.3, -0.2, 1.5});
  EXPECT_TRUE(moved.range().isApprox(space.range()));
  EXPECT_TRUE(moved.min.isApprox(PhiOf(100, -400, 1350, -20, -20, -20)));
  EXPECT_TRUE(moved.max.isApprox(PhiOf(500, 0, 1650, 20, 20, 20)));
}

TEST(SearchSpaceTest, CentredOnANearHeadTheSpaceStaysInFrontOfTheCamera) {
  const SearchSpace space = SpaceOf("wide");
  const SearchSpace moved = space.CentredOn({0, 0, 0.4});
  EXPECT_NEAR(moved.min[2], 0.3, 1e-12);
  EXPECT_TRUE(moved.range().isApprox(space.range()));
}

TEST(SearchSpaceConfigTest, AnEmptyOrInvertedRangeIsRefused) {
  const auto refused = [](const std::function<void(SearchSpaceConfig*)>& change,
                          const std::string& key, const std::string& value,
                          const std::string& other) {
    SearchSpaceConfig config;
    change(&config);
    ExpectRefusal([&] { config.ValidateOrThrow("search."); }, "search." + key, value,
                  "must exceed search." + other);
  };
  refused([](auto* c) { c->min_x_mm = 50, c->max_x_mm = 55; }, "max_x_mm", "55", "min_x_mm");
  refused([](auto* c) { c->min_y_mm = 50, c->max_y_mm = -50; }, "max_y_mm", "-50", "min_y_mm");
  refused([](auto* c) { c->min_z_mm = 900, c->max_z_mm = 900; }, "max_z_mm", "900", "min_z_mm");
}

struct SearchFile {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("search", &search);
  }
  void ValidateOrThrow() const {}
  SearchSpaceConfig search;
};

TEST(SearchSpaceConfigTest, EachKeyHoldsItsRange) {
  const std::pair<const char*, const char*> refused[] = {
      {"preset", "narrow"},    {"min_x_mm", "-3001"},  {"max_x_mm", "3001"},
      {"min_y_mm", ".inf"},    {"max_y_mm", ".nan"},   {"min_z_mm", "299"},
      {"max_z_mm", "5001"},    {"min_z_mm", "0.9"},    {"recentre", "often"},
      {"max_angle_deg", "81"}, {"max_angle_deg", "0"}, {"max_theta_deg", "81"},
      {"max_psi_deg", "-1"}};
  for (const auto& [key, value] : refused) {
    EXPECT_THAT([&] { LoadConfig<SearchFile>("", {std::string("search.") + key + "=" + value}); },
                ::testing::ThrowsMessage<ConfigError>(
                    ::testing::AllOf(::testing::HasSubstr(key), ::testing::HasSubstr(value),
                                     ::testing::HasSubstr("must be"))))
        << key << ' ' << value;
  }
}

}  // namespace
}  // namespace visavis
