# What programs outside need of the messages: component lcmtypes holds headers, .lcm files and the jar
# for lcm-spy; component dev what CMake (find_package(visavis), then visavis::lcmtypes) and pkg-config
# (visavis-lcmtypes) read. Nothing in them depends on the machine.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

install(FILES ${headers} ${include}/visavis/lcm_hardening.hpp
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/visavis COMPONENT lcmtypes)
set(lcm_sources ${VISAVIS_LCM_TYPES})
list(TRANSFORM lcm_sources APPEND .lcm)
install(FILES ${lcm_sources} DESTINATION ${CMAKE_INSTALL_DATADIR}/visavis/lcmtypes
  COMPONENT lcmtypes)
if(VISAVIS_TYPES_JAR_BUILT)
  install(FILES ${VISAVIS_TYPES_JAR} DESTINATION ${CMAKE_INSTALL_DATADIR}/java COMPONENT lcmtypes)
endif()

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/visavis)
install(TARGETS visavis_lcmtypes EXPORT visavis_types)
install(EXPORT visavis_types NAMESPACE visavis:: FILE visavis-targets.cmake
  DESTINATION ${package_dir} COMPONENT dev)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/visavis-config-version.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES visavis-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/visavis-config-version.cmake
  DESTINATION ${package_dir} COMPONENT dev)
configure_file(visavis-lcmtypes.pc.in ${CMAKE_CURRENT_BINARY_DIR}/visavis-lcmtypes.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/visavis-lcmtypes.pc
  DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig COMPONENT dev)
