#include "common/service/service_flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "common/bus/lcm_bus.h"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;

class ServiceFlagsTest : public ::testing::Test {
 protected:
  ServiceFlagsTest() {
    traits_.name = "echo";
    traits_.replays = traits_.runs_fast = true;
    traits_.aliases = {{"--seed", "search.seed", "seed of all that is random"}};
    unsetenv("LCM_DEFAULT_URL");
  }
  ServiceFlags Parse(std::vector<std::string> args) {
    args.insert(args.begin(), "visavis-echo");
    std::vector<char*> argv;
    for (auto& arg : args) argv.push_back(arg.data());
    out_.str("");
    err_.str("");
    return ParseServiceFlags(traits_, static_cast<int>(argv.size()), argv.data(), out_, err_);
  }
  ServiceTraits traits_;
  std::ostringstream out_, err_;
};

TEST_F(ServiceFlagsTest, WithoutFlagsAServiceRunsLiveOnOurUrl) {
  const ServiceFlags flags = Parse({});
  EXPECT_EQ(flags.lcm_url, kDefaultLcmUrl);
  EXPECT_EQ(flags.prefix, "");
  EXPECT_THAT(flags.overrides, IsEmpty());
  EXPECT_TRUE(flags.config_file.empty() && flags.replay.empty() && flags.record.empty());
  EXPECT_FALSE(flags.exit_now || flags.fast || flags.keep_images || flags.check_config);
}

TEST_F(ServiceFlagsTest, TheUrlIsTheFlagsThenTheEnvironments) {
  setenv("LCM_DEFAULT_URL", "memq://env", 1);
  EXPECT_EQ(Parse({}).lcm_url, "memq://env");
  EXPECT_EQ(Parse({"--lcm-url", "memq://flag"}).lcm_url, "memq://flag");
  setenv("LCM_DEFAULT_URL", "", 1);
  EXPECT_EQ(Parse({}).lcm_url, kDefaultLcmUrl);
}

TEST_F(ServiceFlagsTest, OverridesKeepTheirOrderAndAliasesComeLast) {
  EXPECT_THAT(Parse({"--seed", "7", "--set", "a=1", "--set=b.c=2"}).overrides,
              ElementsAre("a=1", "b.c=2", "search.seed=7"));
}

TEST_F(ServiceFlagsTest, ReplayAndFastTakeARecord) {
  const ServiceFlags replay = Parse({"--replay", "i", "--record", "o", "--keep-images"});
  EXPECT_EQ(replay.replay, "i");
  EXPECT_EQ(replay.record, "o");
  EXPECT_TRUE(replay.keep_images && !replay.exit_now);
  const ServiceFlags fast = Parse({"--fast", "--record", "o"});
  EXPECT_TRUE(fast.fast && !fast.exit_now);
}

TEST_F(ServiceFlagsTest, FlagsThatMakeNoSenseTogetherAreBadUsage) {
  for (const std::vector<std::string>& args :
       std::vector<std::vector<std::string>>{{"--fast"},
                                             {"--record", "o"},
                                             {"--keep-images"},
                                             {"--replay", "i", "--keep-images"},
                                             {"--replay", "i", "--fast", "--record", "o"},
                                             {"--bogus"},
                                             {"stray"},
                                             {"--seed"}}) {
    const ServiceFlags flags = Parse(args);
    EXPECT_TRUE(flags.exit_now) << args[0];
    EXPECT_EQ(flags.exit_code, kExitBadUsage) << args[0];
    EXPECT_EQ(out_.str(), "");
    EXPECT_THAT(err_.str(), MatchesRegex("visavis-echo: [^\n]+ \\(--help shows the flags\\)\n"));
  }
}

TEST_F(ServiceFlagsTest, HelpGoesToTheOutputAndABadPrefixIsOneLine) {
  const ServiceFlags help = Parse({"--help"});
  EXPECT_TRUE(help.exit_now);
  EXPECT_EQ(help.exit_code, kExitOk);
  EXPECT_THAT(out_.str(), HasSubstr("--replay"));
  EXPECT_EQ(err_.str(), "");
  EXPECT_EQ(Parse({"--prefix", "a b"}).exit_code, kExitBadUsage);
  EXPECT_THAT(err_.str(), MatchesRegex("visavis-echo: --prefix a b: must be [^\n]+\n"));
}

TEST_F(ServiceFlagsTest, AListIsOfferedWhereThereIsOne) {
  EXPECT_EQ(Parse({"--list"}).exit_code, kExitBadUsage);
  traits_.list_help = "print what there is";
  const ServiceFlags flags = Parse({"--list"});
  EXPECT_TRUE(flags.list && !flags.exit_now);
  EXPECT_FALSE(Parse({}).list);
}

TEST_F(ServiceFlagsTest, WhatAServiceDoesNotOfferIsRefused) {
  traits_ = {};
  traits_.name = "plain";
  traits_.has_config = false;
  for (const std::string flag : {"--replay=x", "--fast", "--record=x", "--config=x", "--set=a=1"}) {
    EXPECT_EQ(Parse({flag}).exit_code, kExitBadUsage) << flag;
  }
}

}  // namespace
}  // namespace visavis
