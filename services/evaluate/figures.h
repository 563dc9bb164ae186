#pragma once

#include <string>

#include "services/evaluate/evaluation.h"
#include "services/evaluate/run_record.h"

namespace visavis {

/// Writes PNG figures into @p folder (made if need be), by way of gnuplot:
///   pose.png    x, y, z and Phi, theta, psi of estimate and truth over time
///   error.png   distance and angle between them over time, with the limits of the shares
///   motion.png  the coordinate in which the truth moves most, as Figs. 12 to 15 of the paper show
///   it
/// Times at which the recogniser was SEARCHING or LOST are shaded. The head offset, where known, is
/// removed. Without truth there is only pose.png.
/// @throws std::runtime_error where a file cannot be written or gnuplot fails or is missing.
void WriteFigures(const RunRecord& record, const Evaluation& evaluation, const std::string& folder);

}  // namespace visavis
