#pragma once

#include <iosfwd>

namespace visavis {

/// visavis-probe listen | exchange: what visavis-fleet asks the LCM network.
/// @return exit code, see RunTool().
int RunProbeTool(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace visavis
