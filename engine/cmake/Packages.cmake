# cpack -G DEB (./dev package): shadowbench, the program with its scenarios, and libshadowbench-dev, the engine for
# other programs. Configure with Release; dpkg-shlibdeps finds the program's dependencies.
set(CPACK_PACKAGE_NAME shadowbench)
set(CPACK_PACKAGE_VENDOR "The shadowbench authors")
set(CPACK_PACKAGE_CONTACT "The shadowbench authors <shadowbench@example.org>")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES TRUE)
set(CPACK_COMPONENTS_ALL program development)

set(CPACK_DEB_COMPONENT_INSTALL TRUE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME shadowbench)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS TRUE)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS gnuplot-nox)  # plots of shadowbench reproduce
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS valgrind)       # shadowbench instructions
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"shadowbench answers: for this scene, at this error, what does each shadow-map
technique cost in time, memory and nodes? Commands run scenarios, compare
results and builds, and serve a web page.")

# The packages that EngineLibraries.cmake finds, by their names in Debian 12.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libshadowbench-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libopenimageio-dev, openimageio-tools, libembree-dev, libopenvdb-dev, \
libblosc-dev, libboost-iostreams-dev, libtbb-dev, libimath-dev, libtinyobjloader-dev, zlib1g-dev, libfmt-dev, \
nlohmann-json3-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"The engine of shadowbench as static libraries with headers, a CMake package
(shadowbench::engine) and a file for pkg-config.")
# Each package brings its licence where Debian looks for it.
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/shadowbench" COMPONENT program RENAME copyright)
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/libshadowbench-dev" COMPONENT development
        RENAME copyright)
include(CPack)
