# Most of the time of a build went into reading the same headers in every file, and into making cold code fast.
#  - Headers that most files of a layer include are precompiled, once for all layers of a kind.
#  - Cold layers, which wait for files, sockets and processes, are compiled with -O1.
# Every file includes what it uses all the same: sanitizer and debug builds, without this, find what is missing.
option(SHADOWBENCH_PRECOMPILE "Precompile the headers that most files include" ON)
set(shadowbench_cold_options "$<$<CONFIG:Release>:-O1>")

set(headers <algorithm> <array> <chrono> <cmath> <cstddef> <cstdint> <filesystem> <functional> <limits> <map> <memory>
            <optional> <ostream> <set> <span> <string> <string_view> <utility> <variant> <vector>)

# A target of its own for each kind, from which the layers take the headers.
function(shadowbench_headers kind)
  cmake_parse_arguments(ARG "" "" "HEADERS;OPTIONS;LIBRARIES" ${ARGN})
  set(empty "${CMAKE_CURRENT_BINARY_DIR}/generated/${kind}_headers.cpp")
  file(CONFIGURE OUTPUT "${empty}" CONTENT "// For the headers that are precompiled with it.\n")
  add_library(shadowbench_${kind}_headers OBJECT "${empty}")
  target_compile_options(shadowbench_${kind}_headers PRIVATE ${ARG_OPTIONS})
  target_link_libraries(shadowbench_${kind}_headers PRIVATE ${ARG_LIBRARIES})
  target_precompile_headers(shadowbench_${kind}_headers PRIVATE ${ARG_HEADERS})
endfunction()

if(SHADOWBENCH_PRECOMPILE)
  shadowbench_headers(standard HEADERS ${headers})
  shadowbench_headers(text HEADERS ${headers} <fmt/format.h> LIBRARIES fmt::fmt)
  shadowbench_headers(cold HEADERS ${headers} <fstream> <fmt/format.h> <nlohmann/json.hpp> OPTIONS ${shadowbench_cold_options}
                      LIBRARIES fmt::fmt nlohmann_json::nlohmann_json)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-fpch-preprocess)  # ccache asks for it
  endif()
endif()

# Gives a layer the precompiled headers of a kind: standard, text (with fmt) or cold (with fmt and JSON).
function(shadowbench_use_headers target kind)
  if(SHADOWBENCH_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM shadowbench_${kind}_headers)
  endif()
endfunction()
