#include "common/service/run_service.h"
#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/recogniser_service.h"

int main(int argc, char* argv[]) {
  return visavis::RunService<visavis::RecogniserService, visavis::RecogniserConfig>(argc, argv);
}
