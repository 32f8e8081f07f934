# What `cmake --install` puts where: the program with its scripts, scenes and documents, and what a program that embeds its
# library needs, find_package(Traverse) or pkg-config (examples/embed, examples/simulate). packaging/debian distributes it.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(share ${CMAKE_INSTALL_DATADIR}/traverse)  # where the program looks for scenes that are not in the working directory
set(examples ${CMAKE_INSTALL_DOCDIR}/examples)
# Where this is from the program and from the shared library, and for programs that contain the library.
foreach(part IN ITEMS BIN LIB)
  file(RELATIVE_PATH ${part} ${CMAKE_INSTALL_FULL_${part}DIR} ${CMAKE_INSTALL_FULL_DATADIR}/traverse)
endforeach()
set_source_files_properties(src/options/installed.cpp PROPERTIES COMPILE_DEFINITIONS
  "DATA_FROM_PROGRAM=\"${BIN}\";DATA_FROM_LIBRARY=\"${LIB}\";DATA=\"${CMAKE_INSTALL_FULL_DATADIR}/traverse\"")

install(TARGETS traverse traverse_shared RUNTIME LIBRARY)
install(PROGRAMS scripts/traverse-check scripts/traverse-fault scripts/traverse-report scripts/traverse-serve
        DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY scripts/traverse_check scripts/traverse_fault scripts/traverse_page scripts/traverse_report
        scripts/traverse_serve DESTINATION ${share}/python
        FILES_MATCHING PATTERN *.py PATTERN *.csv PATTERN *.yml PATTERN *.html PATTERN *.css PATTERN *.js)
file(GLOB several CONFIGURE_DEPENDS scripts/picture*.py scripts/convert*.py)
install(FILES ${several} scripts/animate.py scripts/axle_tables.py scripts/comfort.py scripts/compare.py scripts/compare_data.py
        scripts/engineering_units.csv scripts/engineering_units.py scripts/export.py scripts/export_answers.py
        scripts/export_tables.py scripts/export_xdmf_tables.py scripts/decay.py scripts/export_xdmf.py scripts/fatigue.py
        scripts/option_words.py scripts/page.py scripts/track_quality.py scripts/traffic.py
        scripts/checked_results.py scripts/input_files.py scripts/output_files.py
        scripts/search_answers.py scripts/sensitivity_measures.py
        DESTINATION ${share}/python)
install(DIRECTORY options DESTINATION ${share})
install(FILES packaging/traverse.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(DIRECTORY examples/ packaging/slurm DESTINATION ${examples})
install(FILES README.md CHANGELOG.md CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(DIRECTORY doc DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The documents as a site, with its entry in the desktop's menu, if scripts/site.sh has made it.
install(CODE "
  if(EXISTS \"${PROJECT_BINARY_DIR}/site/html/index.html\")
    file(INSTALL DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}\" TYPE DIRECTORY FILES \"${PROJECT_BINARY_DIR}/site/html\")
    file(INSTALL DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\" TYPE PROGRAM
         FILES \"${PROJECT_SOURCE_DIR}/packaging/desktop/traverse-documents\")
    file(INSTALL DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/applications\" TYPE FILE
         FILES \"${PROJECT_SOURCE_DIR}/packaging/desktop/traverse-documents.desktop\")
  endif()")

# The Python package, where Debian's Python looks: under /usr for all its versions, under /usr/local for the one there is.
# Under any other prefix PYTHONPATH has to say so.
execute_process(COMMAND /usr/bin/python3 -c "import sys; print('python%d.%d' % sys.version_info[:2], end='')"
                OUTPUT_VARIABLE python_version ERROR_QUIET)
install(CODE "set(traverse_python python3)
if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr/local\" AND NOT \"${python_version}\" STREQUAL \"\")
  set(traverse_python ${python_version})
endif()")
install(DIRECTORY python/traverse DESTINATION lib/\${traverse_python}/dist-packages
        FILES_MATCHING PATTERN *.py PATTERN checked_results.py EXCLUDE)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/version.txt CONTENT "${PROJECT_VERSION}\n")
install(FILES ${PROJECT_BINARY_DIR}/version.txt DESTINATION ${share}/python)
install(FILES scripts/checked_results.py ${PROJECT_BINARY_DIR}/version.txt
        DESTINATION lib/\${traverse_python}/dist-packages/traverse)

# The manual page and the shell's completion are what the program itself says of its options.
function(traverse_install_words format folder name)
  install(CODE "
    file(MAKE_DIRECTORY \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder}\")
    execute_process(COMMAND \"$<TARGET_FILE:traverse>\" -help ${format} COMMAND_ERROR_IS_FATAL ANY
                    OUTPUT_FILE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder}/${name}\")
    message(STATUS \"Installing: \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${folder}/${name}\")")
endfunction()
traverse_install_words(man ${CMAKE_INSTALL_MANDIR}/man1 traverse.1)
traverse_install_words(bash ${CMAKE_INSTALL_DATADIR}/bash-completion/completions traverse)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/traverse)
install(TARGETS traverse_core traverse_mechanics EXPORT traverse ARCHIVE)
install(DIRECTORY include/traverse DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT traverse NAMESPACE traverse:: DESTINATION ${package_folder} FILE traverse-targets.cmake)
# Names in small letters, which find_package(Traverse) and find_package(traverse) look for alike.
write_basic_package_version_file(traverse-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES scripts/traverse-config.cmake ${PROJECT_BINARY_DIR}/traverse-config-version.cmake
        DESTINATION ${package_folder})
# MPI has no name that all its implementations share.
if(TRAVERSE_HDF5_MODULE_NAME STREQUAL "hdf5-openmpi")
  set(mpi_module ompi-c)
else()
  list(JOIN MPI_CXX_LIBRARIES " " mpi_libraries)
endif()
file(RELATIVE_PATH to_prefix /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)  # so that what is installed may be moved
configure_file(scripts/traverse.pc.in traverse.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/traverse.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
