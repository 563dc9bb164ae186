#include "tests/support/echo_service.h"

int main(int argc, char* argv[]) {
  return visavis::RunService<visavis::EchoService, visavis::EchoConfig>(argc, argv);
}
