#pragma once

#include <cstdint>

namespace visavis {

/// Calls of malloc, calloc, realloc and the aligned kinds so far, in all threads; -1 where they
/// cannot be counted (sanitizers). It hooks malloc since Eigen and OpenCV do not use operator new.
std::int64_t NumMallocs();

/// Bytes that those calls asked for, never less than the peak: frees are not subtracted, a realloc
/// counts its whole new size. -1 as above.
std::int64_t NumMallocBytes();

}  // namespace visavis
