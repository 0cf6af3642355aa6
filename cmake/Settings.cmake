# How every target of this project is compiled.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

# No fused multiply-add unless the code asks for it: the same bits on every machine.
add_compile_options(-ffp-contract=off)
# GCC 12 frees an error's text twice where a function returns a Result in this way:
# `if (!r || !r->empty()) return r;` (S3Unreadable.AnErrorOfTheCatalogIsAnAnswer). Without this
# analysis it does not.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  add_compile_options(-fno-ipa-modref)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual)
  # gcc 13 and later warn of more; a warning that we have never seen must not end a user's build.
  if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    add_compile_options(-Werror)
  endif()
  # False positives of gcc 12 in optimised standard library code.
  add_compile_options(-Wno-restrict -Wno-maybe-uninitialized -Wno-stringop-overflow -Wno-stringop-overread
    -Wno-array-bounds -Wno-dangling-pointer)
else()
  # clang makes the fuzzers and the sanitized tests; gcc and clang-tidy have warned before.
  add_compile_options(-w)
endif()

# A program starts with the libraries that it uses, not with all that its rooms name.
add_link_options(-Wl,--as-needed)

# What is released resolves its symbols at the start and may not write to their table afterwards.
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT STORMCELLAR_SANITIZE)
  add_link_options(-Wl,-z,relro,-z,now)
endif()

if(STORMCELLAR_SANITIZE)
  add_compile_options(-fsanitize=${STORMCELLAR_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  if(STORMCELLAR_QUICK_TESTS AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # AddressSanitizer ends where these would have done harm; they are a fifth of the code. The
    # fuzzers have them.
    add_compile_options(-fno-sanitize=null,object-size)
  endif()
  add_compile_definitions(STORMCELLAR_SANITIZED)  # compilers have macros of their own for it
  add_link_options(-fsanitize=${STORMCELLAR_SANITIZE})
endif()
