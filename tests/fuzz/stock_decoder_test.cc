// The proof that the fuzz test bites: the same mutations and the same check, compiled against the
// headers as lcm-gen writes them, show each fault that the notes on LCM 1.3.1 list.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "tests/fuzz/decode_check.h"
#include "tests/fuzz/wire_message.h"

namespace visavis {
namespace {

constexpr int kMutations = 150;
constexpr rlim_t kLittleMemory = 200 << 20;      // so that huge arrays fail fast
constexpr rlim_t kMuchMemory = rlim_t{4} << 30;  // address space for a string of 2 GB

/// Checks one input in a child process, since it may not come back.
/// @return "" or the fault's first word: throws, allocates, reused ..., or "crashes".
template <typename T>
std::string FaultInChild(const Bytes& first, const Bytes& input, rlim_t memory) {
  int pipe_fds[2];
  if (pipe(pipe_fds) != 0) return "no pipe";
  const pid_t pid = fork();
  if (pid == 0) {
    const rlimit limit{memory, memory}, no_core{0, 0};
    setrlimit(RLIMIT_AS, &limit);
    setrlimit(RLIMIT_CORE, &no_core);
    std::freopen("/dev/null", "w", stderr);
    T reused{};
    CheckDecode(first, &reused);
    const std::string fault = CheckDecode(input, &reused).fault;
    const bool written = write(pipe_fds[1], fault.data(), fault.size()) >= 0;
    _exit(written ? 0 : 1);
  }
  close(pipe_fds[1]);
  char text[1000] = {};
  const ssize_t length = read(pipe_fds[0], text, sizeof text - 1);
  close(pipe_fds[0]);
  int status = 0;
  waitpid(pid, &status, 0);
  if (WIFSIGNALED(status)) return "crashes";
  const std::string fault(text, length > 0 ? static_cast<std::size_t>(length) : 0);
  return fault.substr(0, fault.find(' '));
}

/// How often each fault shows in @p T.
template <typename T>
std::map<std::string, int> CountFaults() {
  const LcmSchema schema = ReadProjectSchema();
  Random random(20240607);
  std::map<std::string, int> faults;
  for (int i = 0; i < kMutations; ++i) {
    const Bytes first = RandomWireMessage(schema, T::getTypeName(), 3, &random).bytes;
    const WireMessage message = RandomWireMessage(schema, T::getTypeName(), 3, &random);
    ++faults[FaultInChild<T>(first, Mutate(message, &random), kLittleMemory)];
  }
  return faults;
}

class StockDecoderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer takes more memory than the limit allows";
  }
};

TEST_F(StockDecoderTest, MutationsShowThrowsAllocationsAndKeptElements) {
  auto faults = CountFaults<joint_state_t>();
  EXPECT_GT(faults["throws"], 0);  // a negative count: std::length_error, which ends a process
  EXPECT_GT(faults["reused"], 0);  // an array that became empty keeps its old elements
  EXPECT_GT(faults[""], 0);        // and yet it decodes most
  faults = CountFaults<images_t>();
  EXPECT_GT(faults["throws"], 0);
  EXPECT_GT(faults["reused"], 0);
  EXPECT_GT(faults["allocates"], 0);  // as much as a count claims
}

TEST_F(StockDecoderTest, LeastStringLengthCrashes) {
  const LcmSchema schema = ReadProjectSchema();
  Random random(1);
  WireMessage message = RandomWireMessage(schema, "image_metadata_t", 3, &random);
  const Bytes valid = message.bytes;
  EXPECT_EQ(FaultInChild<image_metadata_t>(valid, valid, kMuchMemory), "");
  SetLength(message.lengths[0], INT32_MIN, &message.bytes);
  EXPECT_EQ(FaultInChild<image_metadata_t>(valid, message.bytes, kMuchMemory), "crashes");
}

}  // namespace
}  // namespace visavis
