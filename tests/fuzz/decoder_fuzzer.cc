// libFuzzer's driver: decoder_fuzzer --type=images_t [flags of libFuzzer] [CORPUS]; --list-types.
// An input is a message's body, without the fingerprint. See scripts/fuzz.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/fuzz/decode_by_name.h"

// Of the sanitizers' runtime (sanitizer/allocator_interface.h).
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*,
                                                                             size_t),
                                                         void (*free_hook)(const volatile void*));

namespace visavis {
namespace {

std::atomic<std::int64_t> g_allocated{0};
CheckBody g_check = nullptr;

void OnMalloc(const volatile void*, size_t size) { g_allocated += static_cast<int64_t>(size); }
void OnFree(const volatile void*) {}
std::int64_t NumAllocated() { return g_allocated; }

CheckBody SelectType(int argc, char** argv) {
  const auto checks = AllBodyChecks();
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--list-types") == 0) {
      for (const auto& [name, check] : checks) std::puts(name.c_str());
      std::exit(0);
    }
    if (std::strncmp(argv[i], "--type=", 7) != 0) continue;
    const auto found = checks.find(argv[i] + 7);
    if (found != checks.end()) return found->second;
  }
  std::fprintf(stderr, "decoder_fuzzer: --type=NAME must name a type of --list-types\n");
  std::exit(2);
}

}  // namespace
}  // namespace visavis

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  visavis::g_check = visavis::SelectType(*argc, *argv);
  __sanitizer_install_malloc_and_free_hooks(&visavis::OnMalloc, &visavis::OnFree);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  const auto verdict = visavis::g_check({data, data + size}, &visavis::NumAllocated);
  if (verdict.fault.empty()) return 0;
  std::fprintf(stderr, "decoder_fuzzer: %s\n", verdict.fault.c_str());
  std::abort();
}
