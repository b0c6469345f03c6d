# Makes a build from a clean clone faster. Most of its time went into reading the same headers for every file, compiling
# the same templates (JSON, CLI11) in every file, and optimising cold code.
#  - Cold layers, which wait for files, sockets and processes, are compiled with -O1, each as one file. A name in an
#    unnamed namespace is then common to the layer: two of the same name do not compile.
#  - Hot layers are compiled file by file, so that a function's machine code depends only on its own file. The
#    standard headers that most of them include are precompiled, once for all layers.
# Every file still includes what it uses: debug and sanitizer builds, which do without both, find what is missing.
option(SHADOWBENCH_QUICK_BUILD "Precompile headers, compile cold layers as one file each" ON)

set(shadowbench_precompiled
    <algorithm> <array> <chrono> <cmath> <cstddef> <cstdint> <filesystem> <functional> <limits> <map> <memory> <optional>
    <ostream> <set> <span> <string> <string_view> <utility> <variant> <vector>)

if(SHADOWBENCH_QUICK_BUILD)
  # By default ccache does not cache files that use precompiled headers.
  if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES "(^|/)ccache$")
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros
        "${CMAKE_CXX_COMPILER_LAUNCHER}")
  endif()
  set(precompiled_options)
  set(as_one_options)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # ccache needs the first option. Without the others, GCC 12 repeats its false alarms on std::string (bug 105329) for
    # precompiled headers.
    set(precompiled_options -fpch-preprocess -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
    # The compiler takes all files of the layer for headers, and warns of unnamed namespaces in headers.
    set(as_one_options -Wno-subobject-linkage)
  endif()
  # One target for each kind, from which the layers take the headers.
  foreach(kind IN ITEMS standard text)
    set(empty "${CMAKE_CURRENT_BINARY_DIR}/generated/${kind}_headers.cpp")
    file(CONFIGURE OUTPUT "${empty}" CONTENT "// For the headers that are precompiled with it.\n")
    add_library(shadowbench_${kind}_headers OBJECT "${empty}")
    target_compile_options(shadowbench_${kind}_headers PRIVATE ${precompiled_options})
    target_precompile_headers(shadowbench_${kind}_headers PRIVATE ${shadowbench_precompiled})
  endforeach()
  target_precompile_headers(shadowbench_text_headers PRIVATE <fmt/format.h>)
  target_link_libraries(shadowbench_text_headers PRIVATE fmt::fmt)
endif()

# For the programs of the tests; once, where they are defined.
function(shadowbench_precompile_test_headers)
  if(NOT SHADOWBENCH_QUICK_BUILD)
    return()
  endif()
  set(empty "${CMAKE_BINARY_DIR}/generated/test_headers.cpp")
  file(CONFIGURE OUTPUT "${empty}" CONTENT "// For the headers that are precompiled with it.\n")
  add_library(shadowbench_test_headers OBJECT "${empty}")
  target_compile_options(shadowbench_test_headers PRIVATE ${precompiled_options} $<$<CONFIG:Release>:-O1>)
  target_precompile_headers(shadowbench_test_headers PRIVATE ${shadowbench_precompiled} <gmock/gmock.h> <gtest/gtest.h>
                            <nlohmann/json.hpp>)
  target_link_libraries(shadowbench_test_headers PRIVATE GTest::gtest GTest::gmock nlohmann_json::nlohmann_json)
endfunction()

# How a target is compiled: cold; or standard, text (with fmt) or test (with GoogleTest and JSON), the headers that are
# precompiled for it. Cold layers and tests have -O1.
function(shadowbench_compiled target how)
  if(how MATCHES "^(cold|test)$")
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  if(NOT SHADOWBENCH_QUICK_BUILD)
    return()
  endif()
  if(how STREQUAL "cold")
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    target_compile_options(${target} PRIVATE ${as_one_options})
  else()
    target_precompile_headers(${target} REUSE_FROM shadowbench_${how}_headers)
    target_compile_options(${target} PRIVATE ${precompiled_options})
  endif()
endfunction()

# Compiles these files of a layer of the engine as a cold layer is: with -O1, and as one file.
function(shadowbench_cold_part layer)
  if(NOT SHADOWBENCH_QUICK_BUILD)
    return()
  endif()
  list(TRANSFORM ARGN PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/engine/${layer}/" OUTPUT_VARIABLE files)
  list(TRANSFORM files APPEND ".cpp")
  get_target_property(sources shadowbench_${layer} SOURCES)
  list(REMOVE_ITEM sources ${files})
  add_library(shadowbench_${layer}_cold OBJECT ${files})
  foreach(property IN ITEMS INCLUDE_DIRECTORIES LINK_LIBRARIES)
    get_target_property(value shadowbench_${layer} ${property})
    set_target_properties(shadowbench_${layer}_cold PROPERTIES ${property} "${value}")
  endforeach()
  shadowbench_compiled(shadowbench_${layer}_cold cold)
  set_target_properties(shadowbench_${layer} PROPERTIES
                        SOURCES "${sources};$<TARGET_OBJECTS:shadowbench_${layer}_cold>")
endfunction()
