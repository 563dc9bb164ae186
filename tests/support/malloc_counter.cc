#include "tests/support/malloc_counter.h"

#include <atomic>
#include <cerrno>
#include <cstddef>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#define VISAVIS_ALLOCATOR_IS_TAKEN 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VISAVIS_ALLOCATOR_IS_TAKEN 1
#endif

#if defined(VISAVIS_ALLOCATOR_IS_TAKEN)

std::int64_t visavis::NumMallocs() { return -1; }
std::int64_t visavis::NumMallocBytes() { return -1; }

#else

namespace {

std::atomic<std::int64_t> g_num_mallocs{0};
std::atomic<std::int64_t> g_num_bytes{0};

void Count(std::size_t size) {
  g_num_mallocs.fetch_add(1, std::memory_order_relaxed);
  g_num_bytes.fetch_add(static_cast<std::int64_t>(size), std::memory_order_relaxed);
}

}  // namespace

extern "C" {

// glibc's own allocator behind the names that are replaced here.
// NOLINTBEGIN(bugprone-reserved-identifier): glibc named them.
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) {
  Count(size);
  return __libc_malloc(size);
}

void* calloc(std::size_t n, std::size_t size) {
  Count(n * size);
  return __libc_calloc(n, size);
}

void* realloc(void* p, std::size_t size) {
  Count(size);
  return __libc_realloc(p, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  Count(size);
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }

int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  void* const memory = memalign(alignment, size);
  if (memory == nullptr) return ENOMEM;
  *p = memory;
  return 0;
}

}  // extern "C"

std::int64_t visavis::NumMallocs() { return g_num_mallocs; }
std::int64_t visavis::NumMallocBytes() { return g_num_bytes; }

#endif
