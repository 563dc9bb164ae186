#pragma once

#include <iosfwd>

namespace visavis {

/// The program visavis-evaluate. @return its exit code: 0 done, 1 failed while it ran, 2 bad flags
/// or input (one line on @p err says what).
int RunEvaluateTool(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace visavis
