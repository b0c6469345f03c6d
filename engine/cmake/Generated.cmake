# Sources made at build time: the schema and the API's description as strings, and the facts of this build.
file(READ "${CMAKE_CURRENT_SOURCE_DIR}/engine/scene/scenario.schema.json" SCHEMA_TEXT)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS engine/scene/scenario.schema.json)
configure_file(engine/scene/scenario_schema.cpp.in generated/scenario_schema.cpp @ONLY)
target_sources(shadowbench_scene PRIVATE "${CMAKE_CURRENT_BINARY_DIR}/generated/scenario_schema.cpp")

# Every build reads the commit, but writes the file only if it changed.
add_custom_target(shadowbench_build_info
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${CMAKE_CURRENT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
          -DBUILD_TYPE=${CMAKE_BUILD_TYPE} -DCOMPILER=${CMAKE_CXX_COMPILER_ID}\ ${CMAKE_CXX_COMPILER_VERSION}
          -DOUT=${CMAKE_CURRENT_BINARY_DIR}/generated/build_info.cpp
          -P ${CMAKE_CURRENT_SOURCE_DIR}/engine/cmake/BuildInfo.cmake
  BYPRODUCTS "${CMAKE_CURRENT_BINARY_DIR}/generated/build_info.cpp"
  VERBATIM)
add_dependencies(shadowbench_results shadowbench_build_info)
target_sources(shadowbench_results PRIVATE "${CMAKE_CURRENT_BINARY_DIR}/generated/build_info.cpp")
# Compiled separately, so that another commit does not rebuild its whole layer.
set_source_files_properties("${CMAKE_CURRENT_BINARY_DIR}/generated/build_info.cpp" PROPERTIES
  SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)

file(READ "${CMAKE_CURRENT_SOURCE_DIR}/service/api/openapi.json" OPENAPI_TEXT)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS service/api/openapi.json)
configure_file(service/api/openapi_text.cpp.in generated/openapi_text.cpp @ONLY)
target_sources(shadowbench_api PRIVATE "${CMAKE_CURRENT_BINARY_DIR}/generated/openapi_text.cpp")
