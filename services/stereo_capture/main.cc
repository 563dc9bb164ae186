#include "common/service/run_service.h"
#include "services/stereo_capture/stereo_capture_config.h"
#include "services/stereo_capture/stereo_capture_service.h"

int main(int argc, char* argv[]) {
  return visavis::RunService<visavis::StereoCaptureService, visavis::StereoCaptureConfig>(argc,
                                                                                          argv);
}
