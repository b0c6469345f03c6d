# Runs at installation: the unit of systemd names the program by its full path, and only now the prefix is known.
# UNIT_SOURCE, UNIT_MADE: the unit before and after. UNIT_PROGRAM_FOLDER, UNIT_DOCUMENTATION: as in GNUInstallDirs.
cmake_path(ABSOLUTE_PATH UNIT_PROGRAM_FOLDER BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}" NORMALIZE OUTPUT_VARIABLE PROGRAM)
string(APPEND PROGRAM "/shadowbench")
cmake_path(ABSOLUTE_PATH UNIT_DOCUMENTATION BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}" NORMALIZE
           OUTPUT_VARIABLE DOCUMENTATION)
file(REMOVE "${UNIT_MADE}")  # it may be of another user
configure_file("${UNIT_SOURCE}" "${UNIT_MADE}" @ONLY)
# Not below LIBDIR: systemd looks here.
file(INSTALL DESTINATION "${CMAKE_INSTALL_PREFIX}/lib/systemd/system" TYPE FILE FILES "${UNIT_MADE}")
