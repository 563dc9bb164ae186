#include "services/recogniser/recogniser_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "common/config/config_reader.h"
#include "common/config/config_writer.h"
#include "services/recogniser/fitness_kernel.h"
#include "tests/support/shipped_config.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Each dotted key with its value as text; a list as its elements with commas.
void Flatten(const YAML::Node& node, const std::string& prefix,
             std::map<std::string, std::string>* flat) {
  for (const auto& entry : node) {
    const std::string key = prefix + entry.first.as<std::string>();
    if (entry.second.IsMap()) {
      Flatten(entry.second, key + ".", flat);
    } else if (entry.second.IsSequence()) {
      std::string& text = (*flat)[key];
      for (const auto& element : entry.second) text += element.as<std::string>() + ",";
    } else {
      (*flat)[key] = entry.second.as<std::string>();
    }
  }
}

std::map<std::string, std::string> Keys(const RecogniserConfig& config) {
  std::map<std::string, std::string> flat;
  Flatten(YAML::Load(DumpConfig(config)), "", &flat);
  return flat;
}

TEST(RecogniserConfigTest, TheShippedFileHoldsEveryDefaultKeyByKey) {
  std::map<std::string, std::string> in_file;
  Flatten(YAML::LoadFile(ShippedFile("services/recogniser/recogniser.yaml")), "", &in_file);
  const auto loaded =
      Keys(LoadConfig<RecogniserConfig>(ShippedFile("services/recogniser/recogniser.yaml")));
  const auto defaults = Keys(RecogniserConfig{});
  EXPECT_GT(defaults.size(), 60u);
  for (const auto& [key, value] : defaults) {
    EXPECT_EQ(in_file.count(key), 1u) << key << " is not in the file";
    EXPECT_EQ(loaded.at(key), value) << key;
  }
  for (const auto& entry : in_file) EXPECT_EQ(defaults.count(entry.first), 1u) << entry.first;
}

struct BadValue {
  const char* assignment;
  const char* key;
  const char* rule;
};

TEST(RecogniserConfigTest, BadValuesNameKeyValueAndRule) {
  const BadValue bad_values[] = {
      {"estimator=magic", "estimator", "must be one of"},
      {"feedforward=yes", "feedforward", "must be one of none jacobian exact"},
      {"ego_motion=gps", "ego_motion", "must be one of auto arm camera_pose none"},
      {"arm_wait_ms=-1", "arm_wait_ms", "must be 0 to 1000 ms"},
      {"arm_wait_ms=0.015", "arm_wait_ms", "whole number"},
      {"arm_clock_bound_ms=-1", "arm_clock_bound_ms", "must be 0 to 10000 ms"},
      {"seed=-1", "seed", "must be 0 to"},
      {"simd=MMX", "simd", "must be auto or one of"},
      {"rig_file=/nowhere/rig.yaml", "rig_file", "must be a file that exists"},
      {"population_every=-1", "population_every", "must be 0 to"},
      {"search.preset=tiny", "search.preset", "must be one of"},
      {"search.max_x_mm=-500", "search.max_x_mm", "must exceed search.min_x_mm"},
      {"search.nearest_to=[1, 2]", "search.nearest_to", "must be x y z"},
      {"search.nearest_to=[100, 0, 1000]", "search.nearest_to", "must each be -10 to 10 m"},
      {"start.phi_mm_deg=[1, 2, 3]", "start.phi_mm_deg", "must be six"},
      {"start.phi_mm_deg=here", "start.phi_mm_deg", "list"},
      {"start.spread_mm=-1", "start.spread_mm", "must be 0 to 500 mm"},
      {"ga.individuals=1", "ga.individuals", "must be"},
      {"ga.elite_share=0.9", "ga.immigrant_share", "children"},
      {"published.generations_per_frame=0", "published.generations_per_frame", "must be 1 to"},
      {"published.color.hair_min_p=300", "published.color.hair_min_p", "must be 0 to 255"},
      {"published.fitness.use_site=2", "published.fitness.use_site", "true or false"},
      {"published.track.confirm_frames=0", "published.track.confirm_frames", "must be 1 to"},
      {"refined.budget_ms=-1", "refined.budget_ms", "must be 0 to 10000 ms"},
      {"refined.track_evaluations=31", "refined.track_evaluations", "must be 32 or more"},
      {"refined.head.shape=cube", "refined.head.shape", "must be one of adult ellipsoid sphere"},
      {"refined.head.file=/nowhere/head.obj", "refined.head.file", "/nowhere/head.obj"},
      {"refined.head.scale=0", "refined.head.scale", "must be"},
      {"refined.head.origin_m=[1, 2]", "refined.head.origin_m", "three numbers"},
      {"head.shape=cube", "head.shape", "must be one of sphere ellipsoid"},
      {"head.brow_y_mm=79", "head.brow_y_mm", "above the eye"},
      {"channels.head_pose=head pose", "channels.head_pose", "must be"},
      {"channels.timing=", "channels.timing", "must be"},
      {"colour=red", "colour", ""},
      {"ga.individual=60", "ga.individual", ""},
      {"published.track.min_fit=1", "published.track.min_fit", ""}};
  for (const BadValue& bad : bad_values) {
    const std::string assignment = bad.assignment;
    // A fixed share beside it, whatever the default is.
    EXPECT_THAT(
        [&] {
          LoadConfig<RecogniserConfig>("", {"ga.immigrant_share=0.3", assignment});
        },
        ::testing::ThrowsMessage<ConfigError>(AllOf(HasSubstr(bad.key), HasSubstr(bad.rule))))
        << assignment;
  }
}

TEST(RecogniserConfigTest, EverySimdTargetOfThisMachineMayBeChosen) {
  EXPECT_NO_THROW(LoadConfig<RecogniserConfig>("", {"simd=auto"}));
  std::istringstream names(SimdTargets());
  for (std::string name; std::getline(names, name, ',');) {
    EXPECT_NO_THROW(LoadConfig<RecogniserConfig>("", {"simd=" + name})) << name;
  }
  // Part of a name, or the list itself, is none.
  EXPECT_ANY_THROW(LoadConfig<RecogniserConfig>("", {std::string("simd=") + SimdTargets() + ","}));
  EXPECT_ANY_THROW(LoadConfig<RecogniserConfig>("", {"simd=E"}));
}

TEST(RecogniserConfigTest, FeedforwardIsReadFromItsWord) {
  EXPECT_EQ(ParseFeedforward("none"), FeedforwardMode::kNone);
  EXPECT_EQ(ParseFeedforward("jacobian"), FeedforwardMode::kJacobian);
  EXPECT_EQ(ParseFeedforward("exact"), FeedforwardMode::kExact);
  EXPECT_THAT([] { ParseFeedforward("some"); },
              ::testing::ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("feedforward"), HasSubstr("some"),
                        HasSubstr("must be none, jacobian or exact"))));
}

TEST(RecogniserConfigTest, TheEstimatorGetsWhatIsConfigured) {
  const auto config = LoadConfig<RecogniserConfig>(
      "", {"seed=77", "feedforward=jacobian", "search.preset=paper", "ga.individuals=44",
           "published.generations_per_frame=9", "published.color.hair_min_p=201",
           "published.fitness.normalised=false", "published.track.max_step_mm=33",
           "start.phi_mm_deg=[1, 2, 1003, 4, 5, 6]", "start.spread_mm=12"});
  const PublishedEstimator::Settings settings = config.PublishedSettings();
  EXPECT_EQ(settings.seed, 77u);
  EXPECT_EQ(settings.feedforward, FeedforwardMode::kJacobian);
  EXPECT_TRUE(settings.space.min.isApprox(PhiOf(-100, -100, 900, -20, -20, -20)));
  EXPECT_FALSE(settings.recentre);
  EXPECT_EQ(settings.ga.individuals, 44);
  EXPECT_EQ(settings.published.generations_per_frame, 9);
  EXPECT_EQ(settings.published.color.hair_min_p, 201);
  EXPECT_FALSE(settings.published.fitness.normalised);
  EXPECT_EQ(settings.published.track.max_step_mm, 33);
  EXPECT_EQ(settings.start.phi_mm_deg, (std::vector<double>{1, 2, 1003, 4, 5, 6}));
  EXPECT_EQ(settings.start.spread_mm, 12);
}

}  // namespace
}  // namespace visavis
