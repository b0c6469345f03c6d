# The page: node bundles it from service/web/page, and shadowbench_web contains the bundle.
enable_language(ASM)
find_program(SHADOWBENCH_NODE node DOC "Node.js, which bundles the page")
find_program(SHADOWBENCH_NPM npm DOC "npm, which installs what the bundles are made from")
foreach(program IN ITEMS node npm)
  string(TOUPPER "${program}" name)
  if(NOT SHADOWBENCH_${name})
    message(FATAL_ERROR "${program} is not found, and the page is made with it: install Debian's packages nodejs and npm "
                        "(./dev does), or give its path with -DSHADOWBENCH_${name}=FILE")
  endif()
endforeach()

# All presets share the installed packages, which stay until the lock file changes.
set(web_source "${CMAKE_CURRENT_SOURCE_DIR}/service/web")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS service/web/package-lock.json)
file(SHA256 "${web_source}/package-lock.json" web_lock)
string(SUBSTRING "${web_lock}" 0 16 web_lock)
set(SHADOWBENCH_NODE_PACKAGES "${CMAKE_CURRENT_SOURCE_DIR}/build/node/${web_lock}")
set(web_installed "${SHADOWBENCH_NODE_PACKAGES}/installed")
add_custom_command(OUTPUT "${web_installed}"
  COMMAND ${CMAKE_COMMAND} -DNPM=${SHADOWBENCH_NPM} -DSOURCE=${web_source} -DFOLDER=${SHADOWBENCH_NODE_PACKAGES}
          -P "${CMAKE_CURRENT_SOURCE_DIR}/engine/cmake/InstallNodePackages.cmake"
  COMMENT "Installing the npm packages of the page" VERBATIM)

set(web_built "${CMAKE_CURRENT_BINARY_DIR}/web")
file(GLOB_RECURSE web_pages CONFIGURE_DEPENDS "${web_source}/page/*")
add_custom_command(OUTPUT "${web_built}/assets.s"
  COMMAND ${SHADOWBENCH_NODE} "${web_source}/build.mjs" "${SHADOWBENCH_NODE_PACKAGES}" "${web_built}"
  DEPENDS ${web_pages} "${web_source}/build.mjs" "${web_installed}"
  COMMENT "Bundling the page" VERBATIM)

# Lower case .s: nothing to preprocess. The included files change only together with their etags in it.
set(web_options "-Wa,-I${web_built}")
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  list(APPEND web_options -Wno-unused-command-line-argument)  # of the options for C++, which it gets too
endif()
set_source_files_properties("${web_built}/assets.s" PROPERTIES
  GENERATED TRUE LANGUAGE ASM COMPILE_OPTIONS "${web_options}")
target_sources(shadowbench_web PRIVATE "${web_built}/assets.s")
