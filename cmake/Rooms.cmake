# Compiles a target's sources sixteen at once.
function(stormcellar_batches target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  # A name may be that of another file of the batch; what one function hides of its own is found still.
  target_compile_options(${target} PRIVATE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>)
endfunction()

# stormcellar_room(NAME SOURCES a.cpp b.cpp [PUBLIC libs...] [PRIVATE libs...] [WITHOUT_HEADERS]
#                  [ALONE] [BATCHES [SINGLY directory...]])
#
# Declares the static library of one room: target stormcellar_NAME, alias stormcellar::NAME.
# Headers are included by their room, as in "stormcellar/level2/volume.h". The headers beside the sources are
# installed with the library, unless it is a room's second one (WITHOUT_HEADERS). A room that is ALONE
# names no other and does not use fmt, so the common precompiled headers are not for it. Where everything is
# built once, a room with BATCHES is compiled sixteen files at a time and with less optimisation, but for the
# directories named by SINGLY, in which it spends its time.
function(stormcellar_room name)
  cmake_parse_arguments(ARG "ALONE;BATCHES;WITHOUT_HEADERS" "" "SOURCES;PUBLIC;PRIVATE;SINGLY"
    ${ARGN})
  set(target stormcellar_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(stormcellar::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    # For one release: includes as they were before, "level2/volume.h".
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/stormcellar>)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  if(STORMCELLAR_PRECOMPILE AND NOT ARG_ALONE)
    target_precompile_headers(${target} REUSE_FROM stormcellar_headers)
  endif()
  if(STORMCELLAR_PRECOMPILE AND ARG_BATCHES)
    stormcellar_batches(${target})
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
    foreach(directory IN LISTS ARG_SINGLY)
      set(singly ${ARG_SOURCES})
      list(FILTER singly INCLUDE REGEX "^${directory}/")
      set_source_files_properties(${singly} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
        COMPILE_OPTIONS $<$<CONFIG:Release>:-O3>)
    endforeach()
  endif()
  # Each room is a component of the installed package (cmake/Install.cmake).
  install(TARGETS ${target} EXPORT stormcellar-${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    COMPONENT development)
  set_property(GLOBAL APPEND PROPERTY STORMCELLAR_ROOMS ${name})
  set_property(GLOBAL PROPERTY STORMCELLAR_LINKS_OF_${name} ${ARG_PUBLIC} ${ARG_PRIVATE})
  if(EXISTS ${PROJECT_SOURCE_DIR}/include/stormcellar/${name} AND NOT ARG_WITHOUT_HEADERS)
    install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/stormcellar/${name}
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stormcellar
      COMPONENT development FILES_MATCHING PATTERN "*.h")
  endif()
endfunction()

# The tests themselves, and the command line, need not be fast, but built soon.
set(STORMCELLAR_SHORT_BUILD $<$<CONFIG:Release>:-O1>)
# Under sanitizers what they test is checked for undefined behaviour, they themselves only for memory:
# GoogleTest's and CLI11's templates take most of the time.
if(STORMCELLAR_QUICK_TESTS)
  list(APPEND STORMCELLAR_SHORT_BUILD -O0 -fno-sanitize=undefined)
endif()
set(STORMCELLAR_TEST_BUILD ${STORMCELLAR_SHORT_BUILD})
# Where everything is built once: two minutes less of a release build.
if(STORMCELLAR_PRECOMPILE)
  list(APPEND STORMCELLAR_TEST_BUILD -O0)
endif()

# Builds the modules of videos and of fetching with a program that may load them.
function(stormcellar_with_modules program)
  add_dependencies(${program} stormcellar_fetch_module)
  if(STORMCELLAR_VIDEO)
    add_dependencies(${program} stormcellar_video)
  endif()
endfunction()

# stormcellar_test(NAME SOURCES a_test.cpp [LIBS libs...] [TOGETHER filter] [COMPUTES] [BATCHES])
#
# One test program. Each GoogleTest case becomes a ctest case with the program's name as a label; a
# case that skips itself is shown by ctest as skipped. Cases that share what takes long to make, named
# by a filter of GoogleTest, are one ctest case (NAME_together). A program that
# COMPUTES is optimised wherever it is built. BATCHES has its sources compiled sixteen at once where
# everything is built once: in half the time, but names in their unnamed namespaces must not clash.
function(stormcellar_test name)
  cmake_parse_arguments(ARG "BATCHES;COMPUTES" "TOGETHER" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  set(build ${STORMCELLAR_TEST_BUILD})
  set(headers stormcellar_test_headers)
  if(ARG_COMPUTES)
    set(build ${STORMCELLAR_SHORT_BUILD})
    set(headers stormcellar_computing_test_headers)
  endif()
  target_compile_options(${name} PRIVATE ${build})
  if(STORMCELLAR_PRECOMPILE)
    target_precompile_headers(${name} REUSE_FROM ${headers})
    if(ARG_BATCHES)
      stormcellar_batches(${name})
    endif()
  endif()
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} stormcellar::testing stormcellar_fp_traps
    GTest::gtest GTest::gmock GTest::gtest_main)
  set(apart "*")
  if(ARG_TOGETHER)
    set(apart "-${ARG_TOGETHER}")
    add_test(NAME ${name}_together COMMAND ${name} --gtest_filter=${ARG_TOGETHER})
    set_tests_properties(${name}_together PROPERTIES TIMEOUT 300 LABELS ${name}
      SKIP_REGULAR_EXPRESSION "\\[  SKIPPED \\]")
  endif()
  gtest_discover_tests(${name} TEST_FILTER "${apart}" DISCOVERY_MODE PRE_TEST
    PROPERTIES TIMEOUT 300 LABELS ${name})
endfunction()
