#include "services/recogniser/enrol/enrol_tool.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/config/config_reader.h"
#include "common/tool/run_tool.h"
#include "services/recogniser/enrol/enrolment.h"
#include "services/recogniser/head_file.h"

namespace visavis {
namespace {

constexpr double kDeg = 180 / M_PI;
constexpr double kNarrow_deg = 25;

struct Arguments {
  std::string log, output, config;
  std::vector<std::string> settings;
};

std::string Report(const Arguments& arguments, const Enrolment& e) {
  const auto line = [](const char* format, auto... values) {
    std::string text(200, '\0');
    text.resize(static_cast<std::size_t>(
        std::snprintf(text.data(), text.size(), format, values...)));  // NOLINT
    return text + "\n";
  };
  std::string text = arguments.output + ": a head of " +
                     line("%zu face points from %zu views", e.head.face->points.size(), e.views);
  text += line("tracked in %d of %d pairs; the face seen from %.0f to %.0f deg about the",
               e.tracked, e.frames, kDeg * e.range.min_yaw, kDeg * e.range.max_yaw);
  text += line("vertical and from %.0f to %.0f deg up and down", kDeg * e.range.min_pitch,
               kDeg * e.range.max_pitch);
  text += line("pictures agree with the texture %.3f (at first %.3f), both eyes",
               e.after.texture_ncc, e.before.texture_ncc);
  text += line("%.3f (%.3f), outlines to %.2f px (%.2f px); the face's surface moved %.1f mm",
               e.after.stereo_ncc, e.before.stereo_ncc, e.after.contour_px, e.before.contour_px,
               e.rms_change_mm);
  const double yaw = kDeg * (e.range.max_yaw - e.range.min_yaw);
  const double pitch = kDeg * (e.range.max_pitch - e.range.min_pitch);
  if (yaw < kNarrow_deg || pitch < kNarrow_deg) {
    text +=
        line("the head turned by %.0f deg and nodded by %.0f deg only: beyond these", yaw, pitch);
    text += line("directions it is a guess; %.0f deg each make a good enrolment", kNarrow_deg);
  }
  return text;
}

/// Before the work: that what comes of it can be written, and is not written over its source. A
/// file that is there stays as it is.
void RequireWritable(const Arguments& arguments) {
  namespace fs = std::filesystem;
  std::error_code none;
  if (fs::equivalent(arguments.log, arguments.output, none)) {
    throw std::invalid_argument("--output: " + arguments.output +
                                ": must not be the recording itself");
  }
  const bool existed = fs::exists(arguments.output, none);
  if (!std::ofstream(arguments.output, std::ios::app)) {
    throw std::runtime_error(arguments.output + ": cannot be written");
  }
  if (!existed) fs::remove(arguments.output, none);
}

}  // namespace

int RunEnrolTool(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CLI::App app(
      "Learns a person's head from a short stereo recording in which it turns to all sides; where "
      "refined.head.file is the person's own mesh, its looks alone.",
      "visavis-enrol");
  Arguments arguments;
  app.add_option("LOG", arguments.log,
                 "recording: STEREO_IMAGES, STEREO_RIG and the camera's motion")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_option("-o,--output", arguments.output,
                 "head file, for the recogniser's refined.head.file")
      ->required();
  app.add_option("--config", arguments.config, "settings of the recogniser to enrol with")
      ->check(CLI::ExistingFile);
  app.add_option("--set", arguments.settings, "one of them: KEY=VALUE")->take_all();
  app.callback([&] {
    const auto config = LoadConfig<RecogniserConfig>(arguments.config, arguments.settings);
    RequireWritable(arguments);
    const Enrolment enrolment = Enrol(arguments.log, config);
    SaveHeadFile(arguments.output, enrolment.head);
    out << Report(arguments, enrolment);
  });
  return RunTool(&app, argc, argv, out, err);
}

}  // namespace visavis
