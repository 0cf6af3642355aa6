// The bytes of the built-in map. The assembler includes them, so that the program needs no path to
// find the file.
#include "render/map/base_map.h"

// clang-format off
asm(R"(
    .pushsection .rodata
    .balign 16
    .hidden stormcellar_base_map_begin
    .globl stormcellar_base_map_begin
stormcellar_base_map_begin:
    .incbin ")" STORMCELLAR_BASE_MAP R"("
    .hidden stormcellar_base_map_end
    .globl stormcellar_base_map_end
stormcellar_base_map_end:
    .byte 0
    .popsection
)");
// clang-format on

extern "C" {
extern const std::byte stormcellar_base_map_begin[];
extern const std::byte stormcellar_base_map_end[];
}

namespace stormcellar::render {

std::span<const std::byte> built_in_map_bytes() {
    return {stormcellar_base_map_begin, stormcellar_base_map_end};
}

}  // namespace stormcellar::render
