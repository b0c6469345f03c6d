# cmake -DBUILD= -DWORK= -DVERSION= -DGENERATOR= -DCOMPILER= -DBUILD_TYPE= -P: what BUILD holds is installed below WORK, then
# moved, so that no path of the installation can be in it. The program runs from / and finds its scenarios; a project
# outside the tree finds the engine, and runs.
cmake_minimum_required(VERSION 3.25)
set(prefix "${WORK}/moved")

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text
                  WORKING_DIRECTORY /)
  if(failed)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${failed}:\n${text}")
  endif()
  set(text "${text}" PARENT_SCOPE)
endfunction()

function(expect text part)
  string(FIND "${text}" "${part}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "\"${part}\" is not in:\n${text}")
  endif()
endfunction()

file(REMOVE_RECURSE "${WORK}")
run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${WORK}/installed")
file(RENAME "${WORK}/installed" "${prefix}")

# --- the program ------------------------------------------------------------------------------------------------------
set(program "${CMAKE_COMMAND}" -E env --unset=SHADOWBENCH_SCENARIOS --unset=SHADOWBENCH_DATA
    "${prefix}/bin/shadowbench")
run(${program} --version)
expect("${text}" "shadowbench ${VERSION} ")
run(${program} list scenarios)
expect("${text}" "${prefix}/share/shadowbench/scenarios/quickstart.json")
expect("${text}" "${prefix}/share/shadowbench/scenarios/hard/")
run(${program} run quickstart --only deep --set rays.resolution=16 --set reference.queries=16 --out "${WORK}/results")
expect("${text}" "${WORK}/results/result.json")
run(${program} validate hard/one_hair)
foreach(file IN ITEMS share/shadowbench/scenario.schema.json share/doc/shadowbench/LICENSE
                      share/doc/shadowbench/README.md share/doc/shadowbench/CHANGELOG.md
                      share/doc/shadowbench/engine/compare/README.md share/doc/shadowbench/engine/techniques/README.md
                      share/doc/shadowbench/results/README.md share/doc/shadowbench/scenarios/README.md
                      share/doc/shadowbench/service/README.md share/man/man1/shadowbench.1
                      share/man/man1/shadowbench-run.1 share/bash-completion/completions/shadowbench
                      share/zsh/site-functions/_shadowbench share/fish/vendor_completions.d/shadowbench.fish
                      lib/systemd/system/shadowbench.service share/shadowbench/systemd/tokens.conf)
  if(NOT EXISTS "${prefix}/${file}")
    message(FATAL_ERROR "${file} is not installed")
  endif()
endforeach()

# Images are read and written by a library that is opened when one is: all else starts without OpenImageIO.
run(/lib64/ld-linux-x86-64.so.2 --list "${prefix}/bin/shadowbench")
if(text MATCHES "OpenImageIO")
  message(FATAL_ERROR "The program loads OpenImageIO when it starts:\n${text}")
endif()
run(${program} render hard/one_hair --only deep --size 32x24 --out "${WORK}/pictures")
file(GLOB pictures "${WORK}/pictures/*.png")
if(NOT pictures)
  message(FATAL_ERROR "render wrote no picture:\n${text}")
endif()
file(GLOB images_library "${prefix}/lib*/shadowbench/*.so" "${prefix}/lib*/*/shadowbench/*.so")

# --- the unit of systemd ----------------------------------------------------------------------------------------------
# It names the program by the place where it was installed. systemd checks it, with the drop-in for tokens: a misspelt
# key would otherwise be passed over, and with it a limit.
file(READ "${prefix}/lib/systemd/system/shadowbench.service" unit)
expect("${unit}" "\nExecStart=${WORK}/installed/bin/shadowbench serve ")
find_program(analyze systemd-analyze)
if(analyze)
  string(REPLACE "${WORK}/installed" "${prefix}" unit "${unit}")
  file(WRITE "${WORK}/unit/shadowbench.service" "${unit}")
  file(COPY "${prefix}/share/shadowbench/systemd/tokens.conf" DESTINATION "${WORK}/unit/shadowbench.service.d")
  run("${analyze}" --man=no --recursive-errors=no verify "${WORK}/unit/shadowbench.service")
else()
  message(STATUS "systemd-analyze is missing (Debian's package systemd): the unit is not checked")
endif()

# --- the libraries of an image: service/container -----------------------------------------------------------------------
# What is collected is all that the program and its library load, apart from the C library and its like.
run("${CMAKE_COMMAND}" -E env COLLECT=list "${CMAKE_CURRENT_LIST_DIR}/../../service/container/collect"
    "${prefix}")
string(REGEX MATCHALL "[^\n]+" collected "${text}")
set(image "${WORK}/image")
file(MAKE_DIRECTORY "${image}")
set(all 0)
foreach(library IN LISTS collected)
  file(SIZE "${library}" bytes)
  math(EXPR all "${all} + ${bytes}")
  cmake_path(GET library FILENAME name)
  file(CREATE_LINK "${library}" "${image}/${name}" SYMBOLIC)
endforeach()
# 406 MB on Debian 12 (service/README.md says of what). A new library with many others behind it would be noticed by those
# who pull the image.
if(all GREATER 440000000)
  message(FATAL_ERROR "The libraries of an image of service/container take ${all} bytes: more than 440 MB")
endif()
set(loaded "")
foreach(file IN ITEMS "${prefix}/bin/shadowbench" ${images_library})
  run(/lib64/ld-linux-x86-64.so.2 --inhibit-cache --library-path "${image}" --list "${file}")
  string(REGEX MATCHALL "[^\n]+" lines "${text}")
  list(APPEND loaded ${lines})
endforeach()
expect("${loaded}" "${image}/libOpenImageIO.so")
foreach(line IN LISTS loaded)
  if(line MATCHES "=>" AND NOT line MATCHES "=> ${image}/"
     AND NOT line MATCHES "(libc|libm|libdl|librt|libpthread|libresolv|libgcc_s|ld-linux-x86-64)\\.so")
    message(FATAL_ERROR "An image of service/container would lack a library: ${line}")
  endif()
endforeach()

# --- the engine -------------------------------------------------------------------------------------------------------
file(GLOB_RECURSE pc "${prefix}/*/shadowbench.pc")
cmake_path(GET pc PARENT_PATH pc)
run("${CMAKE_COMMAND}" -E env "PKG_CONFIG_PATH=${pc}" "${CMAKE_COMMAND}" -G "${GENERATOR}"
    "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}" "-DCMAKE_PREFIX_PATH=${prefix}"
    -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK}/build")
expect("${text}" "Generating done")
run("${CMAKE_COMMAND}" --build "${WORK}/build")
foreach(user IN ITEMS by_cmake by_pkg_config)
  run("${WORK}/build/${user}")
  expect("${text}" "visibility 0.2500, expected 0.2500")
endforeach()

# --- a technique from outside ------------------------------------------------------------------------------------------
run("${CMAKE_COMMAND}" -G "${GENERATOR}" "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}"
    "-DCMAKE_PREFIX_PATH=${prefix}" -S "${CMAKE_CURRENT_LIST_DIR}/../external" -B "${WORK}/stairs")
run("${CMAKE_COMMAND}" --build "${WORK}/stairs")
set(library "${WORK}/stairs/libstairs.so")
run(${program} list techniques --technique-library "${library}")
expect("${text}" "external: libstairs.so, hash ")
run(${program} run hard/one_hair --only deep --only stairs --technique-library "${library}" --out "${WORK}/with_stairs")
expect("${text}" "external: stairs from libstairs.so, hash ")
file(STRINGS "${WORK}/stairs/../with_stairs/result.csv" rows REGEX ",stairs,")
expect("${rows}" ",ok,")

# --- the version, which CMake's project() states ------------------------------------------------------------------------
file(READ "${prefix}/share/doc/shadowbench/CITATION.cff" text)
expect("${text}" "\nversion: ${VERSION}\n")
file(READ "${prefix}/share/doc/shadowbench/CHANGELOG.md" text)
expect("${text}" "\n## [${VERSION}] - ")
