#include "services/evaluate/head_offset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/core/random.h"
#include "tests/support/run_log.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::StartsWith;

Eigen::Vector3d Noise(Random* random, double sigma) {
  return sigma * Eigen::Vector3d(random->Normal(), random->Normal(), random->Normal());
}

TEST(HeadOffsetTest, SurvivesNoiseAndFortyPercentOutliers) {
  Random random(1);
  const RigidTransform X_TM = Pose(0.002, 0.02, -0.01, 0.05, 0.1, -0.2);
  std::vector<TruthAndEstimate> pairs;
  for (int i = 0; i < 500; ++i) {
    const RigidTransform X_CT = Pose(random.Uniform(-0.2, 0.2), random.Uniform(-0.2, 0.2), 1,
                                     random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3));
    const bool outlier = i % 5 < 2;
    const RigidTransform noise = MakeTransform(ExpRotation(Noise(&random, outlier ? 0.5 : 0.01)),
                                               Noise(&random, outlier ? 0.1 : 0.002));
    pairs.push_back({X_CT, X_CT * X_TM * noise});
  }
  const HeadOffset offset = FitHeadOffset(pairs);
  // 300 good pairs: three standard errors of the mean are 0.35 mm and 1.7 mrad.
  EXPECT_LT((offset.X_TM.translation() - X_TM.translation()).norm(), 0.5e-3);
  EXPECT_LT(LogRotation(offset.X_TM.linear().transpose() * X_TM.linear()).norm(), 2.5e-3);
  EXPECT_NEAR(offset.rms_m, 0.002 * std::sqrt(3.0), 1e-3);
}

TEST(HeadOffsetTest, RemovingGivesTheTruthsOwnFrame) {
  HeadOffset offset;
  offset.X_TM = Pose(0.002, 0.02, -0.01, 0.05, 0.1, -0.2);
  const RigidTransform X_CT = Pose(0.1, 0.2, 1, 0.1, 0.2, 0.3);
  EXPECT_LT((RemoveOffset(X_CT * offset.X_TM, offset).matrix() - X_CT.matrix()).norm(), 1e-14);
}

TEST(HeadOffsetTest, FilesComeBackAsTheyWere) {
  const TemporaryFolder folder;
  HeadOffset offset;
  offset.X_TM = Pose(0.002, 1.0 / 30, -0.01, 0.05, 0.1, -0.2);
  SaveHeadOffset(offset, folder / "offset.json");
  const HeadOffset loaded = LoadHeadOffset(folder / "offset.json");
  EXPECT_EQ(loaded.X_TM.translation(), offset.X_TM.translation());
  EXPECT_LT((loaded.X_TM.matrix() - offset.X_TM.matrix()).norm(), 1e-15);
  EXPECT_EQ(loaded.source, folder / "offset.json");
}

TEST(HeadOffsetTest, BadFilesAreRefusedWithKeyValueAndRule) {
  const TemporaryFolder folder;
  const std::string path = folder / "offset.json";
  const std::pair<const char*, const char*> cases[] = {
      {"no json", ": must be the JSON that --fit-head-offset writes"},
      {"[1]", ": must be the JSON"},
      {R"({"p_m": [0, 0, 0]})", ": schema: null: must be 1"},
      {R"({"schema": 1, "p_m": [0, 0], "q_wxyz": [1, 0, 0, 0]})",
       ": p_m: [0,0]: must be 3 numbers"},
      {R"({"schema": 1, "p_m": [0, 0, "x"], "q_wxyz": [1, 0, 0, 0]})", ": p_m: [0,0,\"x\"]: must"},
      {R"({"schema": 1, "p_m": [0, 0, 0]})", ": q_wxyz: null: must be 4 numbers"},
      {R"({"schema": 1, "p_m": [0, 0, 0], "q_wxyz": [1, 1, 0, 0]})",
       ": q_wxyz: norm 1.414214: must"},
      {R"({"schema": 1, "p_m": [0, 20, 0], "q_wxyz": [1, 0, 0, 0]})",
       ": p_m: norm 20.000000: must"}};
  for (const auto& [text, complaint] : cases) {
    std::ofstream(path) << text;
    try {
      LoadHeadOffset(path);
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& e) {
      EXPECT_THAT(e.what(), StartsWith(path + complaint));
    }
  }
}

}  // namespace
}  // namespace visavis
