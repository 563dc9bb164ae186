#include <iostream>

#include "services/log_tool/log_tool.h"

int main(int argc, char* argv[]) { return visavis::RunLogTool(argc, argv, std::cout, std::cerr); }
