# Sets how every target of this project is compiled and linked.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

# Use fused multiply-add only if the code asks for it, so that results have the same bits on every machine.
add_compile_options(-ffp-contract=off)
# With the analysis modref, gcc 12 frees an error's text twice if a function returns a Result by
# `if (!r || !r->empty()) return r;` (test S3Unreadable.AnErrorOfTheCatalogIsAnAnswer).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  add_compile_options(-fno-ipa-modref)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    "$<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast;-Wnon-virtual-dtor;-Woverloaded-virtual>")
  # gcc 13 and later have new warnings, which must not make a user's build fail.
  if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    add_compile_options(-Werror)
  endif()
  # gcc 12 gives these warnings falsely for optimized code of the standard library.
  add_compile_options(-Wno-restrict -Wno-maybe-uninitialized -Wno-stringop-overflow -Wno-stringop-overread
    -Wno-array-bounds -Wno-dangling-pointer)
else()
  # clang builds only fuzzers and sanitized tests, whose sources gcc and clang-tidy check for warnings.
  add_compile_options(-w)
endif()

# A program loads only the libraries that it uses, not all libraries that its rooms link.
add_link_options(-Wl,--as-needed)

# A release build resolves all symbols at the start of the program and then makes their table read-only.
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT STORMCELLAR_SANITIZE)
  add_link_options(-Wl,-z,relro,-z,now)
endif()

if(STORMCELLAR_SANITIZE)
  add_compile_options(-fsanitize=${STORMCELLAR_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  if(STORMCELLAR_QUICK_TESTS AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # Leave out two checks that make a fifth of the code, because AddressSanitizer also stops at harmful accesses.
    # The fuzzers keep these checks.
    add_compile_options(-fno-sanitize=null,object-size)
  endif()
  add_compile_definitions(STORMCELLAR_SANITIZED)  # compilers define different macros for sanitizers
  add_link_options(-fsanitize=${STORMCELLAR_SANITIZE})
endif()
