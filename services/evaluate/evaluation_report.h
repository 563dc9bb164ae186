#pragma once

#include <string>

#include "services/evaluate/evaluation.h"

namespace visavis {

/// The evaluation as JSON, schema 1; mm, deg, s, ms; null where unknown. `aligned` and
/// `head_offset` are null without a head offset.
std::string FormatJson(const Evaluation& evaluation);

/// The evaluation as text for a terminal of 80 columns. @p log is its name, @p record tells what
/// was left out.
std::string FormatTable(const std::string& log, const RunRecord& record,
                        const Evaluation& evaluation);

}  // namespace visavis
