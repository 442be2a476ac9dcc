# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
#
# One CTest test for each GoogleTest suite of a program, found when ctest starts. A suite's tests
# share a process: opening a device and preparing its shaders costs more than most of them.
function(nightcity_discover_suites target)
    set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
    string(CONFIGURE [[
execute_process(COMMAND "$<TARGET_FILE:@target@>" --gtest_list_tests
    OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
set(suites 0)
foreach(line IN LISTS lines)
    if(line MATCHES "^([^ ]+)[.](  #.*)?$")
        add_test("${CMAKE_MATCH_1}" "$<TARGET_FILE:@target@>" "--gtest_filter=${CMAKE_MATCH_1}.*")
        math(EXPR suites "${suites} + 1")
    endif()
endforeach()
if(suites EQUAL 0)
    message(FATAL_ERROR "@target@ lists no suite of tests")
endif()
]] content @ONLY)
    file(GENERATE OUTPUT ${list} CONTENT "${content}")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${list})
endfunction()
