#include "services/log_tool/log_tool.h"

#include <iomanip>
#include <ostream>
#include <string>

#include "common/tool/run_tool.h"
#include "services/log_tool/log_info.h"
#include "services/log_tool/sequence_export.h"
#include "services/log_tool/sequence_import.h"

namespace visavis {
namespace {

struct Arguments {
  std::string log, folder, prefix;
};

CLI::App* AddCommand(CLI::App* app, const std::string& name, const std::string& what,
                     Arguments* arguments) {
  CLI::App* command = app->add_subcommand(name, what);
  command->add_option("--prefix", arguments->prefix, "goes before every channel, e.g. ROBOT1_");
  return command;
}

void AddInfo(CLI::App* app, Arguments* arguments, std::ostream& out) {
  CLI::App* command = AddCommand(app, "info", "what a log holds, channel by channel", arguments);
  command->add_option("LOG", arguments->log, "LCM event log")->required()->check(CLI::ExistingFile);
  command->callback([arguments, &out] {
    out << FormatLogInfo(arguments->log, ReadLogInfo(arguments->log, arguments->prefix));
  });
}

void AddImport(CLI::App* app, Arguments* arguments, std::ostream& out) {
  CLI::App* command = AddCommand(app, "import", "a recorded sequence's folder to a log", arguments);
  command
      ->add_option("FOLDER", arguments->folder,
                   "rig.yaml, frames.csv, pictures; camera_pose.csv or arm.csv, truth.csv if known")
      ->required()
      ->check(CLI::ExistingDirectory);
  command->add_option("OUT.lcm", arguments->log, "log to write; replaced when all is well")
      ->required();
  command->callback([arguments, &out] {
    const ImportSummary s = ImportSequence(arguments->folder, arguments->log, arguments->prefix);
    out << arguments->log << ": " << s.num_frames << " frames in " << std::fixed
        << std::setprecision(3) << s.duration_s << " s, " << s.num_truth << " with truth, "
        << s.num_camera_poses << " camera poses, " << s.num_arm_states << " arm states, "
        << std::setprecision(1) << 1e-6 * static_cast<double>(s.num_bytes) << " MB\n";
  });
}

void AddExport(CLI::App* app, Arguments* arguments, std::ostream& out) {
  CLI::App* command = AddCommand(
      app, "export", "a log to a folder of pictures and tables (head_pose.csv too)", arguments);
  command->add_option("IN.lcm", arguments->log, "LCM event log")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("FOLDER", arguments->folder, "must not exist, or be empty")->required();
  command->callback([arguments, &out] {
    const ExportSummary s = ExportSequence(arguments->log, arguments->folder, arguments->prefix);
    out << arguments->folder << ": " << s.num_frames << " frames, " << s.num_pictures
        << " pictures, " << s.num_truth << " with truth, " << s.num_camera_poses
        << " camera poses, " << s.num_arm_states << " arm states, " << s.num_head_poses
        << " head poses\n";
    for (const auto& note : s.notes) out << "  " << note << '\n';
  });
}

}  // namespace

int RunLogTool(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CLI::App app("Looks into LCM event logs, and turns recorded sequences into logs and back.",
               "visavis-log");
  app.require_subcommand(1);
  Arguments arguments;
  AddInfo(&app, &arguments, out);
  AddImport(&app, &arguments, out);
  AddExport(&app, &arguments, out);
  return RunTool(&app, argc, argv, out, err);
}

}  // namespace visavis
