#include "services/evaluate/evaluate_tool.h"

#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>

#include "common/core/provisional_file.h"
#include "common/tool/run_tool.h"
#include "services/evaluate/evaluation.h"
#include "services/evaluate/evaluation_report.h"
#include "services/evaluate/figures.h"

namespace visavis {
namespace {

struct Arguments {
  std::string log, prefix, json, figures, head_offset, fit_head_offset;
  bool align{false};
};

std::optional<HeadOffset> FindOffset(const Arguments& arguments, const RunRecord& record,
                                     std::ostream& err) {
  if (!arguments.head_offset.empty()) return LoadHeadOffset(arguments.head_offset);
  const bool must_fit = !arguments.fit_head_offset.empty();
  if (!arguments.align && !must_fit) return std::nullopt;
  try {
    HeadOffset offset = FitHeadOffset(record);
    offset.source = "fit on " + arguments.log;
    if (must_fit) SaveHeadOffset(offset, arguments.fit_head_offset);
    return offset;
  } catch (const std::invalid_argument& e) {
    const std::string what = arguments.log + ": " + e.what();
    if (must_fit) throw std::invalid_argument(what);
    err << "visavis-evaluate: " << what << "; nothing is aligned\n";
    return std::nullopt;  // A run that never tracked has its figures too.
  }
}

void Run(const Arguments& arguments, std::ostream& out, std::ostream& err) {
  const RunRecord record = ReadRunRecord(arguments.log, arguments.prefix);
  const Evaluation evaluation = Evaluate(record, FindOffset(arguments, record, err));
  if (arguments.json == "-") {
    out << FormatJson(evaluation);
  } else {
    out << FormatTable(arguments.log, record, evaluation);
    if (!arguments.json.empty()) WriteTextFile(arguments.json, FormatJson(evaluation));
  }
  if (!arguments.figures.empty()) WriteFigures(record, evaluation, arguments.figures);
}

}  // namespace

int RunEvaluateTool(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CLI::App app("Compares the HEAD_POSE of a log with its HEAD_POSE_TRUTH.", "visavis-evaluate");
  Arguments arguments;
  app.add_option("LOG", arguments.log, "log of a run: HEAD_POSE, HEAD_POSE_TRUTH if known")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("--json", arguments.json, "write the figures as JSON; '-': to stdout, no table");
  app.add_option("--figures", arguments.figures, "folder for PNG figures (made by gnuplot)");
  auto* given = app.add_option("--head-offset", arguments.head_offset,
                               "remove this head offset, of --fit-head-offset on another log")
                    ->check(CLI::ExistingFile);
  auto* align = app.add_flag("--align-head-frame", arguments.align,
                             "fit the head offset on this log itself and remove it")
                    ->excludes(given);
  app.add_option(
         "--fit-head-offset", arguments.fit_head_offset,
         "fit the constant transform between the truth's head frame and the model's on this "
         "log, and write it to a file")
      ->excludes(given)
      ->excludes(align);
  app.add_option("--prefix", arguments.prefix, "goes before every channel, e.g. ROBOT1_");
  app.callback([&] { Run(arguments, out, err); });
  return RunTool(&app, argc, argv, out, err);
}

}  // namespace visavis
