# What CTest knows of a test beside its command: labels, how long it may take, and which are to start first.
# Under eight busy loops a test with a low priority takes a hundred times as long. What computes without end is stopped
# earlier, by the processor time that it has used (support/main.cpp, support/program.hpp).
set(test_timeout 14400)  # s
set(tests_folder ${CMAKE_CURRENT_LIST_DIR})
file(STRINGS ${tests_folder}/slow.txt slow_rows REGEX "^[0-9]")
file(STRINGS ${tests_folder}/rooms.txt room_rows REGEX "^[a-z]")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${tests_folder}/slow.txt ${tests_folder}/rooms.txt)

# Makes CTest know the cases of a program of one kind once it has been built.
function(traverse_discover program kind)
  set(discover ${tests_folder}/discover.py)
  set(cases ${CMAKE_CURRENT_BINARY_DIR}/${program}_cases.cmake)
  add_custom_command(TARGET ${program} POST_BUILD VERBATIM
    COMMAND /usr/bin/python3 -B ${discover} $<TARGET_FILE:${program}> ${kind} ${test_timeout} ${cases})
  set_property(TARGET ${program} APPEND PROPERTY LINK_DEPENDS ${discover} ${tests_folder}/slow.txt ${tests_folder}/rooms.txt)
  set(included ${CMAKE_CURRENT_BINARY_DIR}/${program}_include.cmake)
  file(WRITE ${included} "if(EXISTS \"${cases}\")\n  include(\"${cases}\")\nelse()\n"
                         "  add_test(${program}_NOT_BUILT ${program}_NOT_BUILT)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${included})
endfunction()

# Labels of a test that is no case of such a program: its kind, quick or slow, and the rooms of its source files.
function(traverse_label name kind)
  set(speed quick)
  foreach(row ${slow_rows})
    if(row MATCHES "^([0-9.]+) +(.+)$" AND CMAKE_MATCH_2 STREQUAL name)
      set(speed slow)
      set_tests_properties(${name} PROPERTIES COST ${CMAKE_MATCH_1})
    endif()
  endforeach()
  set(rooms)
  foreach(source ${ARGN})
    cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${tests_folder})
    foreach(row ${room_rows})
      if(row MATCHES "^(.+): (.+)$" AND CMAKE_MATCH_1 STREQUAL source)
        string(REPLACE ", " ";" named "${CMAKE_MATCH_2}")
        list(APPEND rooms ${named})
      endif()
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES rooms)
  set_tests_properties(${name} PROPERTIES LABELS "${kind};${speed};${rooms}" TIMEOUT ${test_timeout})
endfunction()
