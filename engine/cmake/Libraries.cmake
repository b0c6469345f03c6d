# Every library of the product, from Debian 12 packages (./dev has the list of packages).
include(EngineLibraries)
foreach(package IN LISTS shadowbench_engine_packages)
  separate_arguments(package)
  find_package(${package} REQUIRED)
endforeach()
shadowbench_mend_engine_libraries()

find_path(nanovdb_include nanovdb/NanoVDB.h REQUIRED)  # header only, in a folder that compilers search
mark_as_advanced(nanovdb_include)

find_package(PkgConfig REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(CLI11 REQUIRED CONFIG)
find_package(spdlog REQUIRED CONFIG)
find_package(valijson QUIET CONFIG)
if(NOT TARGET valijson)
  add_library(valijson INTERFACE)  # header only
endif()

# It has no CMake files. Without the flags of its pkg-config file, the classes of httplib differ from its library's.
pkg_check_modules(httplib REQUIRED IMPORTED_TARGET cpp-httplib)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)  # which it uses
pkg_check_modules(prometheus REQUIRED IMPORTED_TARGET prometheus-cpp-core)

# Headers of other projects need not pass this project's warnings.
foreach(target IN ITEMS TBB::tbb Imath::Imath fmt::fmt nlohmann_json::nlohmann_json CLI11::CLI11
                        tinyobjloader::tinyobjloader valijson OpenImageIO::OpenImageIO embree OpenVDB::openvdb
                        Blosc::blosc SQLite::SQLite3 spdlog::spdlog PkgConfig::httplib PkgConfig::prometheus)
  get_target_property(includes ${target} INTERFACE_INCLUDE_DIRECTORIES)
  if(includes)
    set_property(TARGET ${target} APPEND PROPERTY INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${includes})
  endif()
endforeach()
