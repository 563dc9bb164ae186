#pragma once

#include <functional>
#include <iosfwd>

namespace visavis {

/// The program visavis-calibrate. @p stopped is asked while it listens to live channels: true ends
/// that, with what there is. @return its exit code: 0 done, 1 failed while it ran, 2 bad flags or
/// input (one line on @p err says what).
int RunCalibrateTool(int argc, const char* const* argv, const std::function<bool()>& stopped,
                     std::ostream& out, std::ostream& err);

}  // namespace visavis
