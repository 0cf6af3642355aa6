// tests/hard_cases/message_fields.h -- lists the fields of messages, and reads and overwrites their
// numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "base/byte_reader.h"

namespace stormcellar::level2 {

struct MessageField {
    std::string_view name;
    std::size_t at = 0;  // offset in the block, or in the message with its 28 bytes of header
    std::size_t width = 0;
    // True if the field gives the place of gates, or the sweep and azimuth to which they belong.
    bool places_gates = false;
    std::string_view block = {};  // empty: the field is not in a block
};

inline constexpr bool placing = true;

inline constexpr auto header_fields = std::to_array<MessageField>({
    {"terminal manager", 4, 4},
    {"size", 12, 2, placing},
    {"channel", 14, 1},
    {"type", 15, 1, placing},
    {"sequence", 16, 2},
    {"date of the header", 18, 2},
    {"time of the header", 20, 4},
    {"segments", 24, 2},
    {"segment", 26, 2},
});

inline constexpr auto fields_of_31 = std::to_array<MessageField>({
    {"station", 28, 4},
    {"time", 32, 4},
    {"date", 36, 2},
    {"azimuth number", 38, 2},
    {"azimuth", 40, 4, placing},
    {"compression", 44, 1},
    {"spare", 45, 1},
    {"radial length", 46, 2},
    {"spacing", 48, 1},
    {"status", 49, 1, placing},
    {"elevation number", 50, 1, placing},
    {"sector", 51, 1},
    {"elevation", 52, 4, placing},
    {"spot blanking", 56, 1},
    {"azimuth indexing", 57, 1},
    {"number of blocks", 58, 2, placing},
    {"first pointer", 60, 4, placing},
    {"fourth pointer", 72, 4, placing},
});

// Fields in the blocks of message 31.
inline constexpr auto block_fields_of_31 = std::to_array<MessageField>({
    {"name", 0, 4, placing, "RVOL"},      {"size", 4, 2, false, "RVOL"},
    {"version", 6, 2, false, "RVOL"},     {"latitude", 8, 4, false, "RVOL"},
    {"longitude", 12, 4, false, "RVOL"},  {"height", 16, 2, false, "RVOL"},
    {"tower", 18, 2, false, "RVOL"},      {"calibration", 20, 4, false, "RVOL"},
    {"power", 24, 4, false, "RVOL"},      {"ZDR", 32, 4, false, "RVOL"},
    {"phase", 36, 4, false, "RVOL"},      {"pattern", 40, 2, false, "RVOL"},
    {"processing", 42, 2, false, "RVOL"}, {"size", 4, 2, false, "RELV"},
    {"attenuation", 6, 2, false, "RELV"}, {"calibration", 8, 4, false, "RELV"},
    {"size", 4, 2, false, "RRAD"},        {"range", 6, 2, false, "RRAD"},
    {"noise", 8, 4, false, "RRAD"},       {"Nyquist", 16, 2, false, "RRAD"},
    {"flags", 18, 2, false, "RRAD"},
});

inline constexpr auto moment_fields_of_31 = std::to_array<MessageField>({
    {"name", 0, 4, placing, "DREF"},
    {"reserved", 4, 4, false, "DREF"},
    {"gates", 8, 2, placing, "DREF"},
    {"first gate", 10, 2, false, "DREF"},
    {"gate spacing", 12, 2, false, "DREF"},
    {"folding threshold", 14, 2, false, "DREF"},
    {"signal threshold", 16, 2, false, "DREF"},
    {"control flags", 18, 1, false, "DREF"},
    {"word size", 19, 1, placing, "DREF"},
    {"scale", 20, 4, placing, "DREF"},
    {"offset", 24, 4, placing, "DREF"},
});

inline constexpr auto fields_of_1 = std::to_array<MessageField>({
    {"time", 28, 4},
    {"date", 32, 2},
    {"range", 34, 2},
    {"azimuth", 36, 2, placing},
    {"azimuth number", 38, 2},
    {"status", 40, 2, placing},
    {"elevation", 42, 2, placing},
    {"elevation number", 44, 2, placing},
    {"first gate", 46, 2},
    {"first Doppler gate", 48, 2},
    {"gate spacing", 50, 2},
    {"Doppler spacing", 52, 2},
    {"surveillance gates", 54, 2, placing},
    {"Doppler gates", 56, 2, placing},
    {"sector", 58, 2},
    {"calibration", 60, 4},
    {"REF pointer", 64, 2, placing},
    {"VEL pointer", 66, 2, placing},
    {"resolution", 70, 2},
    {"pattern", 72, 2},
    {"spare", 74, 4},
    {"Nyquist", 88, 2},
    {"attenuation", 90, 2},
    {"threshold", 92, 2},
    {"spot blanking", 94, 2},
});

inline constexpr auto fields_of_5 = std::to_array<MessageField>({
    {"size", 28, 2},
    {"pattern", 32, 2},
    {"number of cuts", 34, 2},
    {"first elevation", 50, 2},
});

[[nodiscard]] inline std::uint32_t number_at(std::span<const std::byte> bytes, std::size_t at,
                                             std::size_t width) {
    ByteReader reader{bytes};
    reader.skip(at);
    return width == 1 ? reader.u8() : width == 2 ? reader.u16() : reader.u32();
}

inline void set_number(std::span<std::byte> bytes, std::size_t at, std::size_t width,
                       std::uint32_t number) {
    for (std::size_t i = 0; i < width; ++i)
        bytes[at + i] = static_cast<std::byte>(number >> (8 * (width - 1 - i)));
}

}  // namespace stormcellar::level2
