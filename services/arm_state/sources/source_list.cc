#include "services/arm_state/sources/source_list.h"

#include <stdexcept>

#include "services/arm_state/sources/csv_source.h"
#include "services/arm_state/sources/iiwa_source.h"
#include "services/arm_state/sources/joint_state_source.h"
#include "services/arm_state/sources/panda_source.h"
#include "services/arm_state/sources/simulator_source.h"

namespace visavis {
namespace {

template <typename Source>
std::unique_ptr<ArmSource> Make(const SourceContext& context) {
  return std::make_unique<Source>(context);
}

}  // namespace

const std::vector<SourceKind>& SourceKinds() {
  static const std::vector<SourceKind> kinds = {
      {"iiwa", "IIWA_STATUS", &Make<IiwaSource>},
      {"panda", "PANDA_STATUS", &Make<PandaSource>},
      {"joint_state", "JOINT_STATE", &Make<JointStateSource>},
      {"csv", "", &Make<CsvSource>},
      {"simulator", "SIMULATOR_ARM_STATE", &Make<SimulatorSource>},
  };
  return kinds;
}

const SourceKind& FindSourceKind(const std::string& name) {
  for (const SourceKind& kind : SourceKinds()) {
    if (name == kind.name) return kind;
  }
  throw std::invalid_argument("source: " + name + ": is none");
}

}  // namespace visavis
