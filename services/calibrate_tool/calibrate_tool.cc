#include "services/calibrate_tool/calibrate_tool.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <stdexcept>
#include <string>

#include "common/bus/lcm_bus.h"
#include "common/config/config_reader.h"
#include "common/config/config_writer.h"
#include "common/core/provisional_file.h"
#include "common/rigs/rig_file.h"
#include "common/tool/run_tool.h"
#include "services/calibrate_tool/board_pdf.h"
#include "services/calibrate_tool/calibration_text.h"
#include "services/calibrate_tool/hand_eye_solver.h"
#include "services/calibrate_tool/recorded_views.h"
#include "services/calibrate_tool/report.h"
#include "services/calibrate_tool/stereo_solver.h"

namespace visavis {
namespace {

constexpr int kMinStereoViews = 8, kMinHandEyeViews = 6;
constexpr double kDegree = M_PI / 180;

struct Arguments {
  BoardSpec board;
  std::string paper{"a4"}, pdf;
  std::string board_file, rig, output, report, distortion{"5"};
  double square_mm{0};
  ViewSource source;
  bool live{false};
  HandEyeSettings hand_eye;
  double arm_mm{0.2}, arm_deg{0.02}, max_joint_speed{0.02};
};

Board LoadBoard(const Arguments& arguments) {
  BoardSpec spec = LoadConfig<BoardSpec>(arguments.board_file);
  if (arguments.square_mm > 0) {
    spec.marker_mm *= arguments.square_mm / spec.square_mm;
    spec.square_mm = arguments.square_mm;
  }
  return Board(spec);
}

ViewSource SourceOf(const Arguments& arguments) {
  if (arguments.live == !arguments.source.log.empty())
    throw std::invalid_argument("LOG or --live: one of the two must be given");
  ViewSource source = arguments.source;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  if (source.lcm_url.empty()) source.lcm_url = from_environment ? from_environment : kDefaultLcmUrl;
  return source;
}

/// Refuses at once what could not be written at the end.
void RequireFolder(const std::string& file) {
  if (file.empty()) return;
  const auto folder = std::filesystem::path(file).parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder))
    throw std::invalid_argument(file + ": must lie in a folder that exists");
}

void RunBoard(const Arguments& arguments, std::ostream& out) {
  const Board board(arguments.board);
  const std::filesystem::path pdf(arguments.pdf);
  if (pdf.extension() != ".pdf") throw std::invalid_argument(arguments.pdf + ": must end in .pdf");
  RequireFolder(arguments.pdf);
  const std::string yaml = std::filesystem::path(pdf).replace_extension(".yaml").string();
  WriteTextFile(arguments.pdf, BoardPdf(board, ParsePaper(arguments.paper)));
  WriteTextFile(yaml, DumpConfig(arguments.board) + "\n");
  out << arguments.pdf << ": " << arguments.board.kind << ", " << 1e3 * board.width_m() << " x "
      << 1e3 * board.height_m() << " mm; print it at 100 %, glue it on something flat, measure ten "
      << "squares, and correct square_mm in " << yaml << '\n';
}

DistortionModel DistortionOf(const std::string& word) {
  if (word == "0") return DistortionModel::kNone;
  if (word == "2") return DistortionModel::kRadial;
  return word == "4" ? DistortionModel::kPlumbBob4 : DistortionModel::kPlumbBob5;
}

void RunStereo(const Arguments& arguments, const std::function<bool()>& stopped,
               std::ostream& out) {
  const Board board = LoadBoard(arguments);
  RigDescription result;
  if (!arguments.rig.empty()) result.arm = LoadRigFile(arguments.rig).arm;
  RequireFolder(arguments.output);
  RequireFolder(arguments.report);
  const RecordedViews seen =
      CollectViews(board, SourceOf(arguments), std::nullopt, kMinStereoViews, stopped, out);
  out << seen.summary << '\n';
  StereoSettings settings{seen.sizes.width, seen.sizes.height, seen.sizes.left_width,
                          seen.sizes.left_height};
  settings.distortion = DistortionOf(arguments.distortion);
  const StereoCalibration calibration = CalibrateStereo(board, seen.views, settings);
  out << StereoText(seen.views, calibration);
  result.rig = calibration.rig;
  if (!result.arm && seen.rig) result.arm = seen.rig->arm;
  result.uncertainty = UncertaintyOf(calibration);
  SaveRigFile(result, arguments.output);
  out << arguments.output << " written\n";
  if (arguments.report.empty()) return;
  DrawStereoReport(arguments.report, board, seen.views, calibration);
  out << arguments.report << " drawn\n";
}

void RunHandEye(const Arguments& arguments, const std::function<bool()>& stopped,
                std::ostream& out) {
  const Board board = LoadBoard(arguments);
  RigDescription rig = LoadRigFile(arguments.rig);
  RequireFolder(arguments.output);
  RequireFolder(arguments.report);
  const ViewSource source = SourceOf(arguments);
  const RecordedViews seen = CollectViews(board, source, rig.arm, kMinHandEyeViews, stopped, out);
  if (seen.sizes.width != rig.rig.right.width || seen.sizes.height != rig.rig.right.height ||
      seen.sizes.left_width != rig.rig.left.width || seen.sizes.left_height != rig.rig.left.height)
    throw std::invalid_argument(arguments.rig + ": right, left: must have the images' size");
  if (!seen.postures)
    throw std::invalid_argument(arguments.rig +
                                ": arm: missing: must be given here or by STEREO_RIG");
  if (!rig.arm) rig.arm = seen.rig->arm;
  const ArmPostures::Matched matched = seen.postures->Match(seen.views, arguments.max_joint_speed);
  out << seen.summary << "; of these " << matched.num_unknown << " without arm state, "
      << matched.num_moving << " with the arm moving\n";
  if (static_cast<int>(matched.views.size()) < kMinHandEyeViews) {
    const std::string refusal = seen.postures->last_refusal();
    throw std::invalid_argument("ARM_STATE: " + std::to_string(seen.postures->num_states()) +
                                " states, at rest at " + std::to_string(matched.views.size()) +
                                " views: must be at least " + std::to_string(kMinHandEyeViews) +
                                (refusal.empty() ? "" : "; the last refused: " + refusal));
  }
  HandEyeSettings settings;
  settings.arm_sigma_m = 1e-3 * arguments.arm_mm;
  settings.arm_sigma_rad = arguments.arm_deg * kDegree;
  settings.rig_uncertainty = rig.uncertainty;
  const HandEyeCalibration calibration = CalibrateHandEye(board, rig.rig, matched.views, settings);
  out << HandEyeText(matched.views, calibration);
  rig.X_HC = calibration.X_HC;
  AddUncertainty(calibration, &rig);
  SaveRigFile(rig, arguments.output);
  out << arguments.output << " written\n";
  if (arguments.report.empty()) return;
  DrawHandEyeReport(arguments.report, matched.views, calibration);
  out << arguments.report << " drawn\n";
}

void AddBoard(CLI::App* app, Arguments* a, std::ostream& out) {
  CLI::App* c = app->add_subcommand("board", "prints a board to PDF, and its sizes to a .yaml");
  c->add_option("OUT.pdf", a->pdf, "the .yaml goes beside it")->required();
  c->add_option("--kind", a->board.kind, "charuco or chessboard")
      ->check(CLI::IsMember({"charuco", "chessboard"}))
      ->capture_default_str();
  c->add_option("--columns", a->board.columns, "squares along x")
      ->check(CLI::Range(3, 100))
      ->capture_default_str();
  c->add_option("--rows", a->board.rows, "squares along y")
      ->check(CLI::Range(3, 100))
      ->capture_default_str();
  c->add_option("--square-mm", a->board.square_mm, "side of a square")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  c->add_option("--marker-mm", a->board.marker_mm, "charuco: side of a marker; 3/4 of a square")
      ->check(CLI::Range(0.5, 1000.0));
  c->add_option("--dictionary", a->board.dictionary, "charuco: 4x4, 5x5, 6x6 or 7x7 bits")
      ->check(CLI::IsMember({"4x4", "5x5", "6x6", "7x7"}))
      ->capture_default_str();
  c->add_option("--paper", a->paper, "a0 to a4, letter, tabloid, or WIDTHxHEIGHT in mm")
      ->capture_default_str();
  c->callback([a, c, &out] {
    if (c->count("--marker-mm") == 0) a->board.marker_mm = 0.75 * a->board.square_mm;
    RunBoard(*a, out);
  });
}

void AddViewOptions(CLI::App* c, Arguments* a) {
  CollectorSettings& collector = a->source.collector;
  c->add_option("LOG", a->source.log, "event log with STEREO_IMAGES")->check(CLI::ExistingFile);
  c->add_flag("--live", a->live, "listen to the channels instead; Ctrl-C: calibrate what is there");
  c->add_option("--board", a->board_file, "board.yaml, as `board` writes it")->required();
  c->add_option("--square-mm", a->square_mm, "side of a square as measured")
      ->check(CLI::Range(1.0, 1000.0));
  c->add_option("-o,--output", a->output, "rig.yaml to write")->required();
  c->add_option("--report", a->report, "PNG to draw: coverage and residuals");
  c->add_option("--views", collector.num_views, "enough of them")
      ->check(CLI::Range(kMinHandEyeViews, 1000))
      ->capture_default_str();
  c->add_option("--max-edge-px", collector.max_edge_px, "edges wider are blurred")
      ->check(CLI::Range(1.0, 100.0))
      ->capture_default_str();
  c->add_option("--max-motion-px", collector.max_motion_px, "from one picture to the next")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  c->add_option("--min-change-px", collector.min_change_px, "from any view kept")
      ->check(CLI::Range(0.0, 10000.0))
      ->capture_default_str();
  c->add_option("--lcm-url", a->source.lcm_url,
                std::string("live: LCM network [LCM_DEFAULT_URL, then ") + kDefaultLcmUrl + "]");
  c->add_option("--prefix", a->source.prefix, "goes before every channel, e.g. ROBOT1_");
}

void AddStereo(CLI::App* app, Arguments* a, const std::function<bool()>& stopped,
               std::ostream& out) {
  CLI::App* c = app->add_subcommand("stereo", "both cameras, and where they stand to each other");
  AddViewOptions(c, a);
  c->add_option("--distortion", a->distortion, "coefficients: 0, 2 (k1 k2), 4 (and p1 p2) or 5")
      ->check(CLI::IsMember({"0", "2", "4", "5"}))
      ->capture_default_str();
  c->add_option("--rig", a->rig, "rig.yaml whose arm is taken over")->check(CLI::ExistingFile);
  c->callback([a, &stopped, &out] { RunStereo(*a, stopped, out); });
}

void AddHandEye(CLI::App* app, Arguments* a, const std::function<bool()>& stopped,
                std::ostream& out) {
  CLI::App* c = app->add_subcommand("hand-eye", "where the cameras are on the arm's hand");
  AddViewOptions(c, a);
  c->add_option("--rig", a->rig, "rig.yaml of `stereo`, with the arm or else that of STEREO_RIG")
      ->required()
      ->check(CLI::ExistingFile);
  c->add_option("--arm-mm", a->arm_mm, "how exact the arm is")
      ->check(CLI::Range(0.001, 100.0))
      ->capture_default_str();
  c->add_option("--arm-deg", a->arm_deg, "and in angle")
      ->check(CLI::Range(0.0001, 10.0))
      ->capture_default_str();
  c->add_option("--max-joint-speed", a->max_joint_speed, "[rad/s or m/s] faster is moving")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  c->callback([a, &stopped, &out] { RunHandEye(*a, stopped, out); });
}

}  // namespace

int RunCalibrateTool(int argc, const char* const* argv, const std::function<bool()>& stopped,
                     std::ostream& out, std::ostream& err) {
  CLI::App app("Calibrates two cameras, and where they are on an arm's hand: rig.yaml.",
               "visavis-calibrate");
  app.require_subcommand(1);
  Arguments arguments;
  AddBoard(&app, &arguments, out);
  AddStereo(&app, &arguments, stopped, out);
  AddHandEye(&app, &arguments, stopped, out);
  return RunTool(&app, argc, argv, out, err);
}

}  // namespace visavis
