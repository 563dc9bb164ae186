// RecogniserService: exactly one HEAD_POSE for each pair, whatever comes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "common/convert/pose_message.h"
#include "common/rigs/rig_file.h"
#include "tests/services/recogniser/published_settings.h"
#include "tests/services/recogniser/service_bench.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

RigDescription FixedRig() { return {TinyRig(), std::nullopt, std::nullopt}; }

struct PairCase {
  const char* name;
  std::function<void(images_t*)> change;
  bool estimated;
  const char* reason;  // of the refusal
  friend void PrintTo(const PairCase& c, std::ostream* os) { *os << c.name; }
};

const PairCase kPairCases[] = {
    {"AGoodPair", [](images_t*) {}, true, ""},
    {"Swapped",
     [](images_t* m) {
       std::swap(m->images[0], m->images[1]);
       std::swap(m->image_types[0], m->image_types[1]);
     },
     true, ""},
    {"RightAlone",
     [](images_t* m) {
       m->images.erase(m->images.begin());
       m->image_types = {images_t::RIGHT};
       m->n_images = 1;
     },
     true, ""},
    {"LeftAlone",
     [](images_t* m) {
       m->images.pop_back();
       m->image_types = {images_t::LEFT};
       m->n_images = 1;
     },
     true, ""},
    {"NoImage",
     [](images_t* m) {
       m->images.clear();
       m->image_types.clear();
       m->n_images = 0;
     },
     false, "n_images"},
    {"TwoOfOneType", [](images_t* m) { m->image_types[0] = images_t::RIGHT; }, false,
     "image_types"},
    {"UnknownType", [](images_t* m) { m->image_types[0] = 2; }, false, "image_types"},
    {"OtherSizeThanTheRig", [](images_t* m) { *m = PairAt(m->utime - kBaseUs, SmallRig()); }, false,
     "as in the rig"},
    {"UnknownPixelFormat", [](images_t* m) { m->images[0].pixelformat = 7; }, false, "pixelformat"},
    {"TooFewBytes",
     [](images_t* m) {
       m->images[1].data.resize(100);
       m->images[1].size = 100;
     },
     false, "image_t.size"},
    {"StrideBelowWidth", [](images_t* m) { m->images[1].row_stride = 3; }, false, "row_stride"},
    {"NoSize", [](images_t* m) { m->images[1].width = 0; }, false, "image_t.width"},
    {"DamagedJpeg", [](images_t* m) { m->images[0].pixelformat = image_t::PIXELFORMAT_MJPEG; },
     false, "JPEG"},
    {"NegativeTime", [](images_t* m) { m->utime = -5; }, false, "images_t.utime"},
};

class ServicePairsTest : public ::testing::TestWithParam<PairCase> {};
INSTANTIATE_TEST_SUITE_P(Cases, ServicePairsTest, ::testing::ValuesIn(kPairCases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(ServicePairsTest, GetsOnePoseAndWhatIsRefusedIsCountedAndNamed) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(FixedRig());
  images_t pair = PairAt(100'000, TinyRig());
  GetParam().change(&pair);
  bench.SendPair(67'000, TinyRig());
  bench.Send("STEREO_IMAGES", pair, 100'000);
  bench.SendPair(133'000, TinyRig());
  const auto poses = bench.Poses();
  ASSERT_EQ(poses.size(), 3u);
  for (std::int64_t i = 0; i < 3; ++i) EXPECT_EQ(poses[i].seq, i);
  EXPECT_EQ(poses[1].utime, pair.utime);
  EXPECT_TRUE(HasPose(poses[0]));
  EXPECT_EQ(HasPose(poses[1]), GetParam().estimated);
  EXPECT_TRUE(HasPose(poses[2]));
  EXPECT_EQ(poses[1].status,
            GetParam().estimated ? head_pose_t::STATUS_TRACKING : head_pose_t::STATUS_LOST);
  EXPECT_EQ(bench.reporter().rejected(), GetParam().estimated ? 0 : 1);
  EXPECT_THAT(bench.reporter().last_error(), HasSubstr(GetParam().reason));
  EXPECT_EQ(bench.reporter().processed(), 3);
}

TEST(ServicePairsTest, EachPoseHasItsTiming) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(FixedRig());
  for (std::int64_t i = 0; i < 4; ++i) bench.SendPair(33'000 * i, TinyRig());
  const auto poses = bench.Poses();
  const auto timings = bench.Read<recogniser_timing_t>("RECOGNISER_TIMING");
  ASSERT_EQ(timings.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(timings[i].seq, poses[i].seq);
    EXPECT_EQ(timings[i].utime, poses[i].utime);
    EXPECT_EQ(timings[i].received_utime, poses[i].utime);
    EXPECT_EQ(timings[i].published_utime, poses[i].utime);
    EXPECT_GT(timings[i].generation_ms, 0);
    EXPECT_GE(timings[i].total_ms, timings[i].generation_ms + timings[i].map_ms);
    EXPECT_EQ(timings[i].latency_ms, timings[i].total_ms);  // replay: processing alone
  }
}

TEST(ServicePairsTest, BeforeTheRigPairsAreSearchingWithoutAPose) {
  ServiceBench bench(EasyConfig());
  EXPECT_THAT(bench.Status().state_text, HasSubstr("STEREO_RIG"));
  EXPECT_EQ(bench.Status().state, service_status_t::STATE_DEGRADED);
  for (std::int64_t i = 0; i < 3; ++i) bench.SendPair(33'000 * i, TinyRig());
  const auto poses = bench.Poses();
  ASSERT_EQ(poses.size(), 3u);
  for (const head_pose_t& pose : poses) {
    EXPECT_FALSE(HasPose(pose));
    EXPECT_TRUE(std::isnan(pose.fitness));
    EXPECT_EQ(pose.status, head_pose_t::STATUS_SEARCHING);
    EXPECT_EQ(pose.evaluations, 0);
  }
  EXPECT_EQ(bench.reporter().rejected(), 0);
  bench.SendRig(FixedRig(), 100'000);
  bench.SendPair(100'000, TinyRig());
  EXPECT_TRUE(HasPose(bench.Poses().back()));
  EXPECT_EQ(bench.Poses().back().seq, 3);
  EXPECT_EQ(bench.Status().state_text, "");
}

// A head that nobody tracked cannot be lost.
TEST(ServicePairsTest, ARefusedPairWhileSearchingIsSearching) {
  RecogniserConfig config = EasyConfig();
  config.published.track.min_feat = 1;  // never good
  ServiceBench bench(config);
  bench.SendRig(FixedRig());
  images_t bad = PairAt(33'000, TinyRig());
  bad.image_types[0] = 9;
  bench.SendPair(0, TinyRig());
  bench.Send("STEREO_IMAGES", bad, 33'000);
  for (const head_pose_t& pose : bench.Poses()) {
    EXPECT_EQ(pose.status, head_pose_t::STATUS_SEARCHING);
  }
}

TEST(ServicePairsTest, ARigFileServesUntilARigComes) {
  const TemporaryFolder folder;
  RecogniserConfig config = EasyConfig();
  config.rig_file = folder / "rig.yaml";
  SaveRigFile(FixedRig(), config.rig_file);
  ServiceBench bench(config);
  bench.SendPair(0, TinyRig());
  EXPECT_TRUE(HasPose(bench.Poses().back()));
  EXPECT_EQ(bench.Status().state_text, "");
  bench.SendRig({SmallRig(), std::nullopt, std::nullopt}, 10'000);
  bench.SendPair(33'000, SmallRig());
  EXPECT_TRUE(HasPose(bench.Poses().back()));
}

TEST(ServicePairsTest, JpegPairsAreTrackedAsRawOnesAre) {
  const StereoRig rig = TestRig();
  RecogniserConfig config;
  config.estimator = "published";
  config.head = TestHead();
  config.start.phi_mm_deg = {30, -20, 1000, 4, -5, 3};
  config.published.generations_per_frame = 5;
  const RigidTransform X_CM = TransformFromPhi(PhiOf(30, -20, 1000, 4, -5, 3));
  StereoScene scene(TestHead(), rig);
  const StereoFrame frame = scene.Paint(X_CM);
  ServiceBench bench(config);
  bench.SendRig({rig, std::nullopt, std::nullopt});
  for (std::int64_t i = 0; i < 5; ++i) {
    bench.Send("STEREO_IMAGES", PairOf(frame, 33'000 * i, true), 33'000 * i);
  }
  const RecognitionError error = ComputeRecognitionError(X_CM, FromMessage(bench.Poses().back()));
  EXPECT_LT(error.position.norm(), 0.02);
  EXPECT_EQ(bench.reporter().rejected(), 0);
}

TEST(ServicePairsTest, PairsThatNeverCameAreCountedByTheirNumbers) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(FixedRig());
  const auto send = [&](std::int64_t t_us, std::int64_t seq) {
    images_t pair = PairAt(t_us, TinyRig());
    AddMetadata("seq", seq, &pair.images[0]);
    bench.Send("STEREO_IMAGES", pair, t_us);
  };
  send(0, 10);
  send(33'000, 11);
  send(66'000, 15);  // 12, 13, 14 are missing
  EXPECT_EQ(bench.Status().dropped, 3);
  send(99'000, 2);  // the camera started again
  send(133'000, 3);
  EXPECT_EQ(bench.Status().dropped, 3);
  bench.SendPair(166'000, TinyRig());  // without a number
  send(200'000, 900);
  EXPECT_EQ(bench.Status().dropped, 3);
}

// Garbage numbers count nothing and overflow nowhere.
TEST(ServicePairsTest, NumbersBelowZeroAreNoNumbers) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(FixedRig());
  const std::int64_t numbers[] = {INT64_MIN, INT64_MAX, INT64_MIN, -5, INT64_MAX};
  for (std::int64_t i = 0; i < 5; ++i) {
    images_t pair = PairAt(33'000 * i, TinyRig());
    AddMetadata("seq", numbers[i], &pair.images[0]);
    bench.Send("STEREO_IMAGES", pair, 33'000 * i);
  }
  EXPECT_EQ(bench.Poses().size(), 5u);
  EXPECT_EQ(bench.Status().dropped, 0);
}

TEST(ServicePairsTest, ThePopulationGoesOutWithEachNthPair) {
  RecogniserConfig config = EasyConfig();
  config.population_every = 3;
  ServiceBench bench(config);
  bench.SendRig(FixedRig());
  for (std::int64_t i = 0; i < 7; ++i) bench.SendPair(33'000 * i, TinyRig());
  const auto populations = bench.Read<ga_population_t>("GA_POPULATION");
  ASSERT_EQ(populations.size(), 3u);  // pairs 0, 3, 6
  const auto poses = bench.Poses();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(populations[i].utime, poses[3 * i].utime);
    EXPECT_EQ(populations[i].num_individuals, 20);
    EXPECT_EQ(populations[i].generation, static_cast<std::int64_t>(3 * i + 1));
    EXPECT_NEAR(populations[i].individuals[0].fitness, poses[3 * i].fitness, 1e-6);
    EXPECT_NEAR(populations[i].individuals[0].p_CM_m[2], poses[3 * i].p_CM_m[2], 1e-6);
  }
}

TEST(ServicePairsTest, WithPopulationEvery0NoneGoesOut) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(FixedRig());
  for (std::int64_t i = 0; i < 20; ++i) bench.SendPair(33'000 * i, TinyRig());
  EXPECT_TRUE(bench.Read<ga_population_t>("GA_POPULATION").empty());
}

TEST(ServicePairsTest, UndecodableBytesOnAnyChannelAreCountedAndNameTheChannel) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(FixedRig());
  std::int64_t expected = 0;
  for (const char* channel :
       {"STEREO_IMAGES", "STEREO_RIG", "ARM_STATE", "CAMERA_POSE", "RECOGNISER_COMMAND"}) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{300}}) {
      LogEvent event;
      event.channel = channel;
      event.data.assign(size, 0xa5);
      bench.Dispatch(event, 1000);
      EXPECT_EQ(bench.reporter().rejected(), ++expected) << channel;
      EXPECT_THAT(bench.reporter().last_error(), HasSubstr(channel));
    }
  }
  EXPECT_TRUE(bench.Poses().empty());  // bytes are no pair
  bench.SendPair(33'000, TinyRig());
  EXPECT_TRUE(HasPose(bench.Poses().back()));
}

TEST(ServicePairsTest, WithAPrefixOnlyPrefixedChannelsAreReadAndWritten) {
  RecogniserConfig config = EasyConfig();
  config.population_every = 1;
  ServiceBench bench(config, "ROBOT1_");
  bench.SendRig(FixedRig());
  bench.SendPair(0, TinyRig());
  LogEvent plain;
  plain.channel = "STEREO_IMAGES";
  const images_t pair = PairAt(33'000, TinyRig());
  plain.data.resize(static_cast<std::size_t>(pair.getEncodedSize()));
  pair.encode(plain.data.data(), 0, static_cast<int>(plain.data.size()));
  bench.Dispatch(plain, 33'000);
  EXPECT_EQ(bench.Poses().size(), 1u);
  for (const LogEvent& event : bench.Events()) {
    EXPECT_THAT(event.channel, ::testing::StartsWith("ROBOT1_"));
  }
}

TEST(ServicePairsTest, ChannelsMayBeRenamed) {
  RecogniserConfig config = EasyConfig();
  config.channels.stereo_images = "EYES";
  config.channels.head_pose = "POSE_OF_HEAD";
  ServiceBench bench(config);
  bench.SendRig(FixedRig());
  bench.SendPair(0, TinyRig());
  bench.Send("EYES", PairAt(33'000, TinyRig()), 33'000);
  EXPECT_TRUE(bench.Poses().empty());
  EXPECT_EQ(bench.Read<head_pose_t>("POSE_OF_HEAD").size(), 1u);
}

}  // namespace
}  // namespace visavis
