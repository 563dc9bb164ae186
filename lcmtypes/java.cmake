# The types for lcm-spy: build/share/java/visavis-types.jar. Left out, with a word, where there is no
# JDK or no lcm.jar: nothing else needs it.
option(VISAVIS_JAVA "Build the types jar for lcm-spy where a JDK and liblcm-java are there" ON)
find_program(JAVAC javac)
find_program(JAR jar)
find_file(LCM_JAR lcm.jar PATHS /usr/share/java)
set(VISAVIS_TYPES_JAR ${CMAKE_BINARY_DIR}/share/java/visavis-types.jar)
set(VISAVIS_TYPES_JAR_BUILT FALSE)
if(NOT VISAVIS_JAVA)
  message(STATUS "Types jar for lcm-spy: not built, VISAVIS_JAVA is off")
elseif(NOT JAVAC OR NOT JAR OR NOT LCM_JAR)
  message(STATUS "Types jar for lcm-spy: not built, it needs: "
    "sudo apt-get install default-jdk-headless liblcm-java")
else()
  set(VISAVIS_TYPES_JAR_BUILT TRUE)
  set(java_dir ${CMAKE_CURRENT_BINARY_DIR}/java)
  set(lcm_files ${VISAVIS_LCM_TYPES})
  list(TRANSFORM lcm_files PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  list(TRANSFORM lcm_files APPEND .lcm)
  set(java_files ${VISAVIS_LCM_TYPES})
  list(TRANSFORM java_files PREPEND ${java_dir}/source/visavis/)
  list(TRANSFORM java_files APPEND .java)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/java)
  add_custom_command(OUTPUT ${VISAVIS_TYPES_JAR}
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${java_dir}  # no class of a type that is gone
    COMMAND ${LCM_GEN} --java --jpath ${java_dir}/source ${lcm_files}
    COMMAND ${JAVAC} --release 8 -nowarn -Xlint:-options -cp ${LCM_JAR} -d ${java_dir}/classes ${java_files}
    COMMAND ${JAR} cf ${VISAVIS_TYPES_JAR} -C ${java_dir}/classes visavis
    DEPENDS ${lcm_files} VERBATIM COMMENT "Building the types jar for lcm-spy")
  add_custom_target(visavis_types_jar ALL DEPENDS ${VISAVIS_TYPES_JAR})
endif()
