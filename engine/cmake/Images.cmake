# The program opens what needs OpenImageIO as a shared library, when it first reads or writes an image: see
# service/images/images.h. The library has the few files of the engine that it takes, compiled once more for it; the
# linker names any that are missing here.
set(images_sources
    service/images/library.cpp
    engine/base/error.cpp engine/base/pending_file.cpp engine/base/printable.cpp engine/base/utf8.cpp
    engine/render/colour_map.cpp engine/render/deep_exr.cpp engine/render/display.cpp engine/render/image_file.cpp
    engine/scene/readers/deep_channels.cpp engine/scene/readers/exr_check.cpp engine/scene/readers/extension.cpp
    engine/scene/readers/file_reader.cpp engine/scene/readers/read_alpha.cpp engine/scene/readers/read_deep_image.cpp
    engine/scene/readers/text_lines.cpp
    "${CMAKE_CURRENT_BINARY_DIR}/generated/build_info.cpp")
set_property(SOURCE "${CMAKE_CURRENT_BINARY_DIR}/generated/build_info.cpp" PROPERTY GENERATED ON)
add_library(shadowbench_images MODULE ${images_sources})
add_dependencies(shadowbench_images shadowbench_build_info)
target_include_directories(shadowbench_images PRIVATE engine "${CMAKE_CURRENT_SOURCE_DIR}")
target_link_libraries(shadowbench_images PRIVATE OpenImageIO::OpenImageIO Imath::Imath fmt::fmt)
target_link_options(shadowbench_images PRIVATE -Wl,--as-needed)
if(NOT SHADOWBENCH_SANITIZE)
  target_link_options(shadowbench_images PRIVATE -Wl,--no-undefined)
endif()
target_compile_options(shadowbench_images PRIVATE $<$<CONFIG:Release>:-O1>)
set_target_properties(shadowbench_images PROPERTIES CXX_VISIBILITY_PRESET hidden)

# In the program these functions stand in for the engine's, and nothing else needs OpenImageIO.
target_sources(shadowbench PRIVATE service/images/opened.cpp)
target_link_libraries(shadowbench PRIVATE ${CMAKE_DL_LIBS})
target_link_options(shadowbench PRIVATE -Wl,--as-needed)
add_dependencies(shadowbench shadowbench_images)
set(images_folder "${CMAKE_INSTALL_LIBDIR}/shadowbench")
file(RELATIVE_PATH images_from_program "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}/shadowbench")
set_property(SOURCE service/images/opened.cpp APPEND PROPERTY COMPILE_DEFINITIONS
             SHADOWBENCH_IMAGES_NAME="$<TARGET_FILE_NAME:shadowbench_images>"
             SHADOWBENCH_IMAGES_FROM_PROGRAM="${images_from_program}")
install(TARGETS shadowbench_images LIBRARY DESTINATION "${images_folder}" COMPONENT program)
