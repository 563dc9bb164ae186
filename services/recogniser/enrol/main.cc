#include <iostream>

#include "services/recogniser/enrol/enrol_tool.h"

int main(int argc, char* argv[]) { return visavis::RunEnrolTool(argc, argv, std::cout, std::cerr); }
