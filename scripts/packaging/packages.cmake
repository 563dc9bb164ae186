# Three .deb files by CPack: visavis (programs), visavis-lcmtypes (headers, jar), visavis-dev (CMake).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Visavis developers <visavis@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package's first line is its own
set(CPACK_PACKAGE_VERSION ${VISAVIS_PACKAGE_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
  GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs lcmtypes dev)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION TRUE)

# Debian's own papers, one set a package.
set(doc ${CMAKE_CURRENT_BINARY_DIR}/doc)
file(MAKE_DIRECTORY ${doc})
file(COPY ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${doc})
file(RENAME ${doc}/LICENSE ${doc}/copyright)
configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${doc}/CHANGELOG.md COPYONLY)
execute_process(COMMAND gzip -9nf ${doc}/CHANGELOG.md)
foreach(pair IN ITEMS programs:visavis lcmtypes:visavis-lcmtypes dev:visavis-dev)
  string(REPLACE : ";" pair ${pair})
  list(GET pair 0 component)
  list(GET pair 1 package)
  install(FILES ${doc}/copyright ${doc}/CHANGELOG.md.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
    COMPONENT ${component} EXCLUDE_FROM_ALL)
  string(TOUPPER ${component} component)
  set(CPACK_DEBIAN_${component}_PACKAGE_NAME ${package})
endforeach()
foreach(service IN LISTS services)
  string(REPLACE - _ name ${service})
  install(FILES ${PROJECT_SOURCE_DIR}/services/${name}/README.md RENAME ${service}.md
    DESTINATION /usr/share/doc/visavis COMPONENT programs EXCLUDE_FROM_ALL)
endforeach()

set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION
"${PROJECT_DESCRIPTION}
Services that talk through LCM: stereo capture, arm state, recogniser, logger,
simulator; tools to record, evaluate, enrol and calibrate; systemd units.")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
# Called by name, so that dpkg-shlibdeps does not see them.
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS
  "systemd | systemd-standalone-sysusers, iproute2")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS
  "chrony | time-daemon, gnuplot-nox, liblcm-bin, openssh-client, sudo")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS
  "ethtool, linuxptp, openssh-server, tcpdump, visavis-lcmtypes")
set(conffiles ${CMAKE_CURRENT_BINARY_DIR}/conffiles)
list(TRANSFORM services PREPEND /etc/visavis/ OUTPUT_VARIABLE text)
list(TRANSFORM text APPEND .yaml)
list(JOIN text "\n" text)
file(WRITE ${conffiles} "${text}\n/etc/sudoers.d/visavis-fleet\n")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA ${conffiles}
  ${CMAKE_CURRENT_SOURCE_DIR}/debian/postinst ${CMAKE_CURRENT_SOURCE_DIR}/debian/postrm
  ${CMAKE_CURRENT_SOURCE_DIR}/debian/prerm)

set(CPACK_COMPONENT_LCMTYPES_DESCRIPTION
"LCM messages of Visavis
C++ headers, .lcm files, and visavis-spy: lcm-spy with their classes.")
set(CPACK_DEBIAN_LCMTYPES_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LCMTYPES_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_LCMTYPES_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_LCMTYPES_PACKAGE_RECOMMENDS "default-jre, liblcm-java, libjchart2d-java")

set(CPACK_COMPONENT_DEV_DESCRIPTION
"CMake package and pkg-config file of Visavis' messages
find_package(visavis) gives visavis::lcmtypes.")
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "visavis-lcmtypes (= ${VISAVIS_PACKAGE_VERSION}), liblcm-dev, libglib2.0-dev, pkg-config")

include(CPack)
