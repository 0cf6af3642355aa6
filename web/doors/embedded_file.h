// web/doors/embedded_file.h -- links files into the program, so that it needs no path to find them.
// The assembler includes their bytes.
//
//   STORMCELLAR_EMBED(viewer_page, PAGE_DIRECTORY "/index.html");        // at file scope
//   std::string_view page = STORMCELLAR_EMBEDDED(viewer_page);
//
// The path is a string literal. The build must list the file in OBJECT_DEPENDS of the source.
#pragma once

#include <string_view>

// clang-format off
#define STORMCELLAR_EMBED(name, path)               \
    asm(".pushsection .rodata\n"                    \
        ".hidden stormcellar_" #name "_begin\n"     \
        ".globl stormcellar_" #name "_begin\n"      \
        "stormcellar_" #name "_begin:\n"            \
        ".incbin \"" path "\"\n"                    \
        ".hidden stormcellar_" #name "_end\n"       \
        ".globl stormcellar_" #name "_end\n"        \
        "stormcellar_" #name "_end:\n"              \
        ".byte 0\n"                                 \
        ".popsection\n");                           \
    extern "C" const char stormcellar_##name##_begin[], stormcellar_##name##_end[]
// clang-format on

#define STORMCELLAR_EMBEDDED(name)                           \
    std::string_view {                                       \
        stormcellar_##name##_begin, stormcellar_##name##_end \
    }
