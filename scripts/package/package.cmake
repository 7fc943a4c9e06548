# What is installed beside the tools, and the Debian package. The top CMakeLists.txt includes this file.

# The files of the tools are the component "tools", which is all that the package holds. The library for other programs is the
# component "development", which `cmake --install` adds.
set(modules base math color paint formats library quality brdf materials image display envmap prefilter mesh rays fit capture render panels sketch studio report)
foreach(module ${modules})
  set_target_properties(goniochrome_${module} PROPERTIES EXPORT_NAME ${module})
  target_include_directories(goniochrome_${module} PUBLIC $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/goniochrome>)
  install(
    TARGETS goniochrome_${module}
    EXPORT goniochrome
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  install(
    DIRECTORY ${PROJECT_SOURCE_DIR}/lib/${module}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/goniochrome
    COMPONENT development
    FILES_MATCHING
    PATTERN "*.h"
    PATTERN "*_for_test.h" EXCLUDE
    PATTERN "codecs" EXCLUDE)
endforeach()

include(CMakePackageConfigHelpers)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Goniochrome)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/GoniochromeConfig.cmake.in ${PROJECT_BINARY_DIR}/GoniochromeConfig.cmake
                              INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/GoniochromeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT goniochrome NAMESPACE goniochrome:: FILE GoniochromeTargets.cmake DESTINATION ${config_folder} COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/GoniochromeConfig.cmake ${PROJECT_BINARY_DIR}/GoniochromeConfigVersion.cmake
        DESTINATION ${config_folder} COMPONENT development)

# The scripts that work on an installed toolchain, with the modules that they import; they find the sample data beside them.
install(
  DIRECTORY ${PROJECT_SOURCE_DIR}/scripts/batch ${PROJECT_SOURCE_DIR}/scripts/paint_book ${PROJECT_SOURCE_DIR}/scripts/shared
            ${PROJECT_SOURCE_DIR}/scripts/accuracy_report
  DESTINATION ${CMAKE_INSTALL_DATADIR}/goniochrome/scripts
  USE_SOURCE_PERMISSIONS
  PATTERN "__pycache__" EXCLUDE
  PATTERN "*.bats" EXCLUDE
  PATTERN "*_test.py" EXCLUDE
  PATTERN "*_test.bash" EXCLUDE)
install(PROGRAMS ${PROJECT_SOURCE_DIR}/scripts/paint-book ${PROJECT_SOURCE_DIR}/scripts/accuracy-report
                 ${PROJECT_SOURCE_DIR}/scripts/common.sh DESTINATION ${CMAKE_INSTALL_DATADIR}/goniochrome/scripts)
# They are commands by links, because Python looks for the modules of a script beside the file that a link leads to. A wheel can
# hold no links, so there they are commands by scripts of one line.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/commands)
foreach(script paint-book batch/paint-batch accuracy-report)
  get_filename_component(command ${script} NAME)
  set(command ${PROJECT_BINARY_DIR}/commands/${command})
  if(SKBUILD)
    file(WRITE ${command} "#!/bin/sh\nexec \"$(dirname \"$(readlink -f \"$0\")\")/../share/goniochrome/scripts/${script}\" \"$@\"\n")
  else()
    file(RELATIVE_PATH target ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/goniochrome/scripts/${script})
    file(CREATE_LINK ${target} ${command} SYMBOLIC)
  endif()
  install(PROGRAMS ${command} TYPE BIN)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME goniochrome)
# The field has to hold an address; the domain .invalid says that there is none (RFC 2606).
set(CPACK_PACKAGE_CONTACT "The Goniochrome project <goniochrome@goniochrome.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "computer-aided color appearance design of effect paints")
string(CONCAT CPACK_PACKAGE_DESCRIPTION
    "Single-purpose tools that take a measured or designed goniochromatic paint\n"
    "(metallic, pearl, interference) to a picture under real HDR light and to\n"
    "the aspecular Lab file that a formulation system mixes from.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL tools)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# OSMesa, or EGL in its place, is opened at run time by the engine gl alone, and the other engines draw without it.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libosmesa6 | libegl1, libosmesa6 | libgl1-mesa-dri, python3")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "bash-completion, snakemake, parallel, openimageio-tools, python3-numpy, python3-openimageio")
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian-files.cmake)
set(CPACK_GONIOCHROME_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
include(CPack)

if(GONIOCHROME_TESTS)
  add_test(NAME project.consumer COMMAND ${CMAKE_CURRENT_LIST_DIR}/consumer_test.sh ${PROJECT_BINARY_DIR} ${CMAKE_CXX_COMPILER})
  # The program is compiled with the flags of the libraries, which sanitizers demand.
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  set_tests_properties(project.consumer PROPERTIES COST 40 TIMEOUT 300 ENVIRONMENT "CXXFLAGS=${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}")
  add_test(NAME project.wheel COMMAND bats --tap ${CMAKE_CURRENT_LIST_DIR}/wheel.bats)
  set_tests_properties(
    project.wheel
    PROPERTIES
      COST 40
      TIMEOUT 900
      ENVIRONMENT
      "PATH=${CMAKE_RUNTIME_OUTPUT_DIRECTORY}:$ENV{PATH};TESTDATA=${testdata};GONIOCHROME_BUILD=${PROJECT_BINARY_DIR}")
endif()
