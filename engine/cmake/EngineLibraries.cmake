# The outside libraries of the engine. This build reads the list, and so do users of the installed package.

# Each as the arguments of find_package.
set(shadowbench_engine_packages "TBB CONFIG" "Imath CONFIG" "fmt CONFIG" ZLIB "nlohmann_json CONFIG"
    "tinyobjloader CONFIG" "OpenImageIO CONFIG" "embree 3 CONFIG" OpenVDB Blosc)

# Debian keeps the find modules of OpenVDB and Blosc out of CMake's way.
list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")

# Call it once they are found.
function(shadowbench_mend_engine_libraries)
  # The Debian package exports an include folder that does not exist.
  get_target_property(includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
  list(FILTER includes EXCLUDE REGEX "opencv4")
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${includes}")
endfunction()
