#include "common/tool/run_tool.h"

#include <exception>
#include <ostream>
#include <stdexcept>

#include "common/service/version.h"

namespace visavis {

int RunTool(CLI::App* app, int argc, const char* const* argv, std::ostream& out,
            std::ostream& err) {
  app->set_version_flag("--version", app->get_name() + " " + kVersion);
  const auto fail = [&](const char* what, int exit_code) {
    err << app->get_name() << ": " << what << '\n';
    return exit_code;
  };
  try {
    app->parse(argc, argv);
    if (!out.flush()) return fail("cannot write to standard output", 1);
    return 0;
  } catch (const CLI::Success& e) {  // --help and --version
    return app->exit(e, out, err);
  } catch (const CLI::ParseError& e) {
    return fail((std::string(e.what()) + " (--help shows the flags)").c_str(), 2);
  } catch (const std::invalid_argument& e) {
    return fail(e.what(), 2);
  } catch (const std::exception& e) {
    return fail(e.what(), 1);
  }
}

}  // namespace visavis
