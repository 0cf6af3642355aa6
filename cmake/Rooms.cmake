# Compiles the sources of a target in batches of sixteen, each batch as one source.
function(stormcellar_batches target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  # Do not warn if a local name hides a name of another file of the batch. gcc still warns if a local name hides
  # another local name.
  target_compile_options(${target} PRIVATE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local>)
endfunction()

# stormcellar_room(NAME SOURCES a.cpp b.cpp [PUBLIC libs...] [PRIVATE libs...] [WITHOUT_HEADERS]
#                  [ALONE] [BATCHES [SINGLY directory...]])
#
# Declares the static library of a room (a directory of the project): target stormcellar_NAME, alias
# stormcellar::NAME. Installs the room's public headers, include/stormcellar/NAME, unless WITHOUT_HEADERS is given.
# A room that is ALONE uses neither other rooms nor fmt, so it cannot use the common precompiled headers. If
# STORMCELLAR_PRECOMPILE is on, a room with BATCHES is compiled in batches and with less optimization, except for
# the directories named by SINGLY, whose code takes most of the time at run time.
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
    # Until the next release, old includes such as "level2/volume.h" work, too.
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
      # A source that is compiled alone hides no name of another file, so warn of every hidden name again.
      set_source_files_properties(${singly} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON
        COMPILE_OPTIONS "$<$<CONFIG:Release>:-O3>;-Wshadow")
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

# The code of tests and of the command line need not be fast, so compile it with less optimization.
set(STORMCELLAR_SHORT_BUILD $<$<CONFIG:Release>:-O1>)
# For quick tests under sanitizers, check only the rooms for undefined behavior, and not the code of tests and of
# the command line. The templates of GoogleTest and CLI11 would take most of the time.
if(STORMCELLAR_QUICK_TESTS)
  list(APPEND STORMCELLAR_SHORT_BUILD -O0 -fno-sanitize=undefined)
endif()
set(STORMCELLAR_TEST_BUILD ${STORMCELLAR_SHORT_BUILD})
# If everything is built once, this saves two minutes of a release build.
if(STORMCELLAR_PRECOMPILE)
  list(APPEND STORMCELLAR_TEST_BUILD -O0)
endif()

# Makes a build of the program also build the modules that the program may load: fetching, videos, GRIB2
# and OpenVDB.
function(stormcellar_with_modules program)
  add_dependencies(${program} stormcellar_fetch_module)
  if(STORMCELLAR_VIDEO)
    add_dependencies(${program} stormcellar_video)
  endif()
  if(STORMCELLAR_GRIB)
    add_dependencies(${program} stormcellar_grib)
  endif()
  if(STORMCELLAR_VDB)
    add_dependencies(${program} stormcellar_vdb)
  endif()
endfunction()

# stormcellar_test(NAME SOURCES a_test.cpp [LIBS libs...] [TOGETHER filter] [COMPUTES] [BATCHES])
#
# Declares a test program. Each GoogleTest case becomes a ctest case, labeled with the program's name; ctest shows
# a case that skips itself as skipped. The cases that match the GoogleTest filter of TOGETHER become one ctest case
# (NAME_together), because they share data that take long to make. A program that COMPUTES is always optimized. If
# STORMCELLAR_PRECOMPILE is on, BATCHES compiles the sources in batches, which takes half the time; names in their
# unnamed namespaces must then not clash.
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
