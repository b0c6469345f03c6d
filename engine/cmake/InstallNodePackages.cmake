# cmake -DNPM= -DSOURCE= -DFOLDER= -P: installs the packages of SOURCE/package-lock.json into FOLDER/node_modules. One
# call at a time, since builds of several presets may run it together.
file(MAKE_DIRECTORY "${FOLDER}")
file(LOCK "${FOLDER}/lock" GUARD PROCESS)
if(EXISTS "${FOLDER}/installed")
  return()
endif()
file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" "${SOURCE}/.npmrc" DESTINATION "${FOLDER}")
execute_process(COMMAND "${NPM}" ci WORKING_DIRECTORY "${FOLDER}" OUTPUT_VARIABLE text ERROR_VARIABLE text
                RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "npm ci in ${FOLDER} failed; it needs the npm registry once:\n${text}")
endif()
file(TOUCH "${FOLDER}/installed")
