# find_package(visavis) gives visavis::lcmtypes: C++ headers <visavis/X_t.hpp>, and LCM itself.
include(CMakeFindDependencyMacro)
find_dependency(PkgConfig)
if(NOT TARGET PkgConfig::LCM)
  pkg_check_modules(LCM QUIET IMPORTED_TARGET lcm)  # Debian's liblcm-dev ships no CMake package.
endif()
if(NOT TARGET PkgConfig::LCM)
  set(visavis_FOUND FALSE)
  set(visavis_NOT_FOUND_MESSAGE "visavis needs LCM: sudo apt-get install liblcm-dev libglib2.0-dev")
  return()
endif()
include(${CMAKE_CURRENT_LIST_DIR}/visavis-targets.cmake)
