#include "common/service/run_service.h"
#include "services/arm_state/arm_state_config.h"
#include "services/arm_state/arm_state_service.h"

int main(int argc, char* argv[]) {
  return visavis::RunService<visavis::ArmStateService, visavis::ArmStateConfig>(argc, argv);
}
