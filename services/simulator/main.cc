#include "common/service/run_service.h"
#include "services/simulator/simulator_config.h"
#include "services/simulator/simulator_service.h"

int main(int argc, char* argv[]) {
  return visavis::RunService<visavis::SimulatorService, visavis::SimulatorConfig>(argc, argv);
}
