#include <iostream>

#include "services/probe_tool/probe_tool.h"

int main(int argc, char* argv[]) { return visavis::RunProbeTool(argc, argv, std::cout, std::cerr); }
