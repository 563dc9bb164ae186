#include "common/service/run_service.h"
#include "services/logger/logger_config.h"
#include "services/logger/logger_service.h"

int main(int argc, char* argv[]) {
  return visavis::RunService<visavis::LoggerService, visavis::LoggerConfig>(argc, argv);
}
