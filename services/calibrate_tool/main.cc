#include <iostream>

#include "common/service/stop_signal.h"
#include "services/calibrate_tool/calibrate_tool.h"

int main(int argc, char* argv[]) {
  const visavis::StopSignal stop;
  return visavis::RunCalibrateTool(
      argc, argv, [&stop] { return stop.pending(); }, std::cout, std::cerr);
}
