# Precompiles the headers that most sources include, so that a whole build takes a third less time. This is off
# by default: it hides missing includes, ccache keeps nothing, and clang-tidy cannot read headers that gcc
# precompiled. .ci/run turns it on, because it builds everything once.
if(NOT STORMCELLAR_PRECOMPILE)
  return()
endif()

# gcc collects garbage when it has allocated 128 MB, which takes up to a sixth of the time of a batch of sources.
# Without collecting, a batch needs up to 1.3 GB of memory instead of 1.0 GB. So collect later if there are more
# than 2.5 GB for each processor.
cmake_host_system_information(RESULT memory_mb QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT processors QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR memory_mb_each "${memory_mb} / ${processors}")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND memory_mb_each GREATER 2500)
  add_compile_options(--param=ggc-min-heapsize=2000000)
endif()

# gcc 12 for arm64 crashes if it reads the header of SVE after a precompiled header.
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  add_compile_definitions("HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
endif()

set(STORMCELLAR_COMMON_HEADERS <algorithm> <array> <chrono> <filesystem> <fmt/format.h> <functional>
  <map> <memory> <optional> <span> <string> <string_view> <utility> <variant> <vector>)

# Precompiled headers belong to a target, and a target needs a source, so use an empty program.
set(STORMCELLAR_NO_SOURCE ${PROJECT_BINARY_DIR}/generated/nothing.cpp)
file(CONFIGURE OUTPUT ${STORMCELLAR_NO_SOURCE} CONTENT "int main() {}\n")

# Only sources that are compiled with the same options can use a precompiled header, so rooms, the command line
# and programs each have their own.
function(stormcellar_common_headers name)
  target_compile_options(${name} PRIVATE ${ARGN})
  target_link_libraries(${name} PRIVATE fmt::fmt)
  target_precompile_headers(${name} PRIVATE ${STORMCELLAR_COMMON_HEADERS})
endfunction()
add_library(stormcellar_headers STATIC ${STORMCELLAR_NO_SOURCE})
stormcellar_common_headers(stormcellar_headers)
add_library(stormcellar_command_headers STATIC ${STORMCELLAR_NO_SOURCE})
stormcellar_common_headers(stormcellar_command_headers ${STORMCELLAR_TEST_BUILD})
target_link_libraries(stormcellar_command_headers PRIVATE CLI11::CLI11)
target_precompile_headers(stormcellar_command_headers PRIVATE <CLI/CLI.hpp>)
add_executable(stormcellar_program_headers ${STORMCELLAR_NO_SOURCE})
stormcellar_common_headers(stormcellar_program_headers ${STORMCELLAR_TEST_BUILD})

if(STORMCELLAR_TESTS)
  find_package(GTest REQUIRED)
  function(stormcellar_test_headers name)
    add_executable(${name} ${STORMCELLAR_NO_SOURCE})
    target_compile_options(${name} PRIVATE ${ARGN})
    target_link_libraries(${name} PRIVATE fmt::fmt GTest::gtest GTest::gmock)
    target_precompile_headers(${name} PRIVATE ${STORMCELLAR_COMMON_HEADERS} <gmock/gmock.h>
      <gtest/gtest.h>)
  endfunction()
  stormcellar_test_headers(stormcellar_test_headers ${STORMCELLAR_TEST_BUILD})
  stormcellar_test_headers(stormcellar_computing_test_headers ${STORMCELLAR_SHORT_BUILD})
endif()
