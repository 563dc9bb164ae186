#pragma once

#include <iosfwd>

namespace visavis {

/// visavis-enrol. @return its exit code: 0 done, 1 failed on the way, 2 bad flags or a recording
/// that shows too little.
int RunEnrolTool(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace visavis
