# cmake --install: the program with its scenarios (component program), and the engine as a CMake package and for
# pkg-config (component development), in the folders of the GNU standards below any prefix.
get_property(layers GLOBAL PROPERTY shadowbench_engine_layers)

# --- the program ------------------------------------------------------------------------------------------------------
set(share "${CMAKE_INSTALL_DATADIR}/shadowbench")
install(TARGETS shadowbench RUNTIME COMPONENT program)
install(DIRECTORY scenarios DESTINATION "${share}" COMPONENT program PATTERN README.md EXCLUDE)
install(FILES engine/scene/scenario.schema.json service/api/openapi.json DESTINATION "${share}" COMPONENT program)
install(FILES README.md CHANGELOG.md CITATION.cff LICENSE "${CMAKE_CURRENT_BINARY_DIR}/web/licences.txt"
        DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)
# Manual pages and the completions of shells, from the program's own help.
set(help "${CMAKE_CURRENT_BINARY_DIR}/generated/share")
add_custom_command(OUTPUT "${help}.made"
  COMMAND ${CMAKE_COMMAND} -E rm -rf "${help}"
  COMMAND shadowbench help-files --out "${help}"
  COMMAND ${CMAKE_COMMAND} -E touch "${help}.made"
  DEPENDS shadowbench VERBATIM)
add_custom_target(help_files ALL DEPENDS "${help}.made")
install(DIRECTORY "${help}/" DESTINATION "${CMAKE_INSTALL_DATADIR}" COMPONENT program)
# The unit of systemd, with the paths of the prefix that it is installed to, and a drop-in to copy.
install(FILES service/systemd/tokens.conf DESTINATION "${share}/systemd" COMPONENT program)
install(CODE "set(UNIT_SOURCE \"${CMAKE_CURRENT_SOURCE_DIR}/service/systemd/shadowbench.service.in\")
set(UNIT_MADE \"${CMAKE_CURRENT_BINARY_DIR}/generated/shadowbench.service\")
set(UNIT_PROGRAM_FOLDER \"${CMAKE_INSTALL_BINDIR}\")
set(UNIT_DOCUMENTATION \"${CMAKE_INSTALL_DOCDIR}\")" COMPONENT program)
install(SCRIPT engine/cmake/InstallUnit.cmake COMPONENT program)
# The manuals keep their folders, so that the links between them hold.
foreach(folder IN ITEMS engine/compare engine/techniques results scenarios service)
  install(FILES ${folder}/README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}/${folder}" COMPONENT program)
endforeach()

# The program finds its scenarios relative to its own folder.
file(RELATIVE_PATH share_from_program "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_DATADIR}/shadowbench")
set_property(SOURCE service/cli/scenario_files.cpp APPEND PROPERTY COMPILE_DEFINITIONS
             SHADOWBENCH_SHARE_FROM_PROGRAM="${share_from_program}")

# --- the engine -------------------------------------------------------------------------------------------------------
# Its headers include each other from the top of the engine ("base/error.h"), so that is the include folder.
set(headers "${CMAKE_INSTALL_INCLUDEDIR}/shadowbench")
install(DIRECTORY engine/ DESTINATION "${headers}" COMPONENT development FILES_MATCHING PATTERN "*.h"
        PATTERN cmake EXCLUDE)

add_library(shadowbench_engine INTERFACE)
add_library(shadowbench::engine ALIAS shadowbench_engine)
set(engine_targets engine ${layers})
list(TRANSFORM engine_targets PREPEND shadowbench_)
list(TRANSFORM layers PREPEND shadowbench_ OUTPUT_VARIABLE layer_targets)
target_link_libraries(shadowbench_engine INTERFACE ${layer_targets})
target_compile_features(shadowbench_engine INTERFACE cxx_std_20)
foreach(target IN LISTS engine_targets)
  string(REPLACE "shadowbench_" "" name "${target}")
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
endforeach()
install(TARGETS ${engine_targets} EXPORT shadowbench ARCHIVE COMPONENT development
        INCLUDES DESTINATION "${headers}")

# What a technique from outside is compiled with: headers alone, without the engine and its libraries.
set(technique_headers techniques/external)
install(DIRECTORY engine/${technique_headers}/ DESTINATION "${headers}/${technique_headers}" COMPONENT development
        FILES_MATCHING PATTERN "*.hpp")
add_library(shadowbench_technique INTERFACE)
add_library(shadowbench::technique ALIAS shadowbench_technique)
target_include_directories(shadowbench_technique INTERFACE
                           "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/engine/${technique_headers}>"
                           "$<INSTALL_INTERFACE:${headers}/${technique_headers}>")
target_compile_features(shadowbench_technique INTERFACE cxx_std_20)
set_target_properties(shadowbench_technique PROPERTIES EXPORT_NAME technique)
install(TARGETS shadowbench_technique EXPORT shadowbench-technique)

add_custom_target(installed DEPENDS shadowbench ${layer_targets} COMMENT "All that is installed")
add_dependencies(installed help_files)

include(CMakePackageConfigHelpers)
set(package "${CMAKE_INSTALL_LIBDIR}/cmake/shadowbench")
set(made "${CMAKE_CURRENT_BINARY_DIR}/generated")
configure_package_config_file(engine/cmake/shadowbench-config.cmake.in "${made}/shadowbench-config.cmake"
                              INSTALL_DESTINATION "${package}")
write_basic_package_version_file("${made}/shadowbench-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(EXPORT shadowbench-technique NAMESPACE shadowbench:: FILE shadowbench-technique-targets.cmake
        DESTINATION "${package}" COMPONENT development)
install(EXPORT shadowbench NAMESPACE shadowbench:: FILE shadowbench-targets.cmake DESTINATION "${package}"
        COMPONENT development)
install(FILES "${made}/shadowbench-config.cmake" "${made}/shadowbench-config-version.cmake"
              engine/cmake/EngineLibraries.cmake DESTINATION "${package}" COMPONENT development)

# A linker looks for a library's symbols in the libraries after it, so the uppermost layer comes first.
set(pc_libraries "${layer_targets}")
list(REVERSE pc_libraries)
list(TRANSFORM pc_libraries PREPEND "-l")
list(JOIN pc_libraries " " pc_libraries)
set(pc "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
file(RELATIVE_PATH pc_to_prefix "/${pc}" "/")
configure_file(engine/cmake/shadowbench.pc.in "${made}/shadowbench.pc" @ONLY)
install(FILES "${made}/shadowbench.pc" DESTINATION "${pc}" COMPONENT development)
