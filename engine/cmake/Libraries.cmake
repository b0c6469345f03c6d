# Every library of the product, from Debian 12 packages (the list of packages is in ./dev).
find_package(PkgConfig REQUIRED)
find_package(TBB REQUIRED)
find_package(Imath REQUIRED CONFIG)
find_package(fmt REQUIRED CONFIG)
find_package(ZLIB REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(nlohmann_json REQUIRED CONFIG)
find_package(CLI11 REQUIRED CONFIG)
find_package(tinyobjloader REQUIRED CONFIG)
find_package(valijson QUIET CONFIG)
if(NOT TARGET valijson)
  add_library(valijson INTERFACE)  # header only
endif()

find_package(OpenImageIO REQUIRED CONFIG)
# The Debian package exports an include folder that is not there.
get_target_property(oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER oiio_includes EXCLUDE REGEX "opencv4")
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${oiio_includes}")

find_package(embree 3 REQUIRED CONFIG)

list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
find_package(OpenVDB REQUIRED)

# No CMake files of their own. Without the flags of its pkg-config the classes of httplib differ from its library's.
pkg_check_modules(httplib REQUIRED IMPORTED_TARGET cpp-httplib)
pkg_check_modules(prometheus REQUIRED IMPORTED_TARGET prometheus-cpp-core)

# Other people's headers do not have to pass our warnings.
foreach(target IN ITEMS TBB::tbb Imath::Imath fmt::fmt nlohmann_json::nlohmann_json CLI11::CLI11
                        tinyobjloader::tinyobjloader valijson OpenImageIO::OpenImageIO embree OpenVDB::openvdb
                        SQLite::SQLite3 PkgConfig::httplib PkgConfig::prometheus)
  get_target_property(includes ${target} INTERFACE_INCLUDE_DIRECTORIES)
  if(includes)
    set_property(TARGET ${target} APPEND PROPERTY INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${includes})
  endif()
endforeach()
