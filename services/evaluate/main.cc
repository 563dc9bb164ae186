#include <iostream>

#include "services/evaluate/evaluate_tool.h"

int main(int argc, char* argv[]) {
  return visavis::RunEvaluateTool(argc, argv, std::cout, std::cerr);
}
