#include "tests/support/malloc_counter.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace visavis {
namespace {

// A pointer that the compiler must take for used, so that it keeps the allocation.
void Use(void* p) { asm volatile("" : : "g"(p) : "memory"); }

class MallocCounterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
    calls_ = NumMallocs();
    bytes_ = NumMallocBytes();
  }
  std::int64_t Calls() const { return NumMallocs() - calls_; }
  std::int64_t Bytes() const { return NumMallocBytes() - bytes_; }

 private:
  std::int64_t calls_{}, bytes_{};
};

TEST_F(MallocCounterTest, CountsNothingWhereNothingIsAllocated) {
  std::vector<int> none;
  Use(&none);
  EXPECT_EQ(Calls(), 0);
  EXPECT_EQ(Bytes(), 0);
}

TEST_F(MallocCounterTest, CountsNewAndVectors) {
  const auto number = std::make_unique<char[]>(100);
  Use(number.get());
  std::vector<double> numbers(10);
  Use(numbers.data());
  EXPECT_EQ(Calls(), 2);
  EXPECT_EQ(Bytes(), 180);
}

TEST_F(MallocCounterTest, CountsTheCFamily) {
  void* p = std::malloc(10);
  Use(p);
  p = std::realloc(p, 20);
  Use(p);
  void* const q = std::calloc(3, 7);
  Use(q);
  EXPECT_EQ(Calls(), 3);
  EXPECT_EQ(Bytes(), 51);
  std::free(p);
  std::free(q);
}

TEST_F(MallocCounterTest, CountsAlignedMemoryAndAlignsIt) {
  void* p = nullptr;
  ASSERT_EQ(posix_memalign(&p, 64, 100), 0);
  Use(p);
  void* const q = std::aligned_alloc(128, 256);
  Use(q);
  EXPECT_EQ(Calls(), 2);
  EXPECT_EQ(Bytes(), 356);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(p) % 64, 0u);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(q) % 128, 0u);
  std::free(p);
  std::free(q);
  EXPECT_EQ(posix_memalign(&p, 3, 100), EINVAL);
}

TEST_F(MallocCounterTest, FreeingIsNotSubtracted) {
  for (int i = 0; i < 3; ++i) Use(std::make_unique<int>(i).get());
  EXPECT_EQ(Calls(), 3);
}

}  // namespace
}  // namespace visavis
