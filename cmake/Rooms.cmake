# stormcellar_room(NAME SOURCES a.cpp b.cpp [PUBLIC libs...] [PRIVATE libs...] [WITHOUT_HEADERS])
#
# Declares the static library of one room: target stormcellar_NAME, alias stormcellar::NAME.
# Headers are included by their room, as in "level2/volume.h". The headers beside the sources are
# installed with the library, unless it is a room's second one (WITHOUT_HEADERS).
function(stormcellar_room name)
  cmake_parse_arguments(ARG "WITHOUT_HEADERS" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target stormcellar_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(stormcellar::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/stormcellar>)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  install(TARGETS ${target} EXPORT stormcellarTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  if(NOT ARG_WITHOUT_HEADERS)
    install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stormcellar/${name}
      FILES_MATCHING PATTERN "*.h")
  endif()
endfunction()

# stormcellar_test(NAME SOURCES a_test.cpp [LIBS libs...] [LABELS labels...])
#
# One test program. Each GoogleTest case becomes a ctest case; a case that skips itself is shown by
# ctest as skipped.
function(stormcellar_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  # The rooms are tested as they are released; the tests themselves need not be fast, but built soon.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(STORMCELLAR_QUICK_TESTS)
    target_compile_options(${name} PRIVATE -O0)
    target_precompile_headers(${name} REUSE_FROM stormcellar_test_headers)
  endif()
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} stormcellar::testing GTest::gtest GTest::gmock
    GTest::gtest_main)
  set(properties TIMEOUT 300)
  if(ARG_LABELS)
    list(APPEND properties LABELS "${ARG_LABELS}")
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST PROPERTIES ${properties})
endfunction()
