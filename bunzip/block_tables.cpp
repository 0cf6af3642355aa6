#include "bunzip/block_tables.h"

#include <algorithm>
#include <bit>

namespace stormcellar::bunzip {

Found BlockTables::read(BitReader& reader) {
    Found found = read_bytes(reader);
    if (found == Found::good) found = read_selectors(reader);
    if (found == Found::good) found = read_codes(reader);
    return found;
}

Found BlockTables::read_bytes(BitReader& reader) {
    const auto ranges = reader.read(16);
    if (!ranges) return Found::cut;
    byte_count = 0;
    for (unsigned range = 0; range < 16; ++range) {
        if ((*ranges >> (15 - range) & 1U) == 0) continue;
        const auto there = reader.read(16);
        if (!there) return Found::cut;
        for (unsigned i = 0; i < 16; ++i) {
            if ((*there >> (15 - i) & 1U) != 0)
                bytes[byte_count++] = static_cast<std::uint8_t>(range * 16 + i);
        }
    }
    return byte_count == 0 ? Found::bad : Found::good;
}

Found BlockTables::read_selectors(BitReader& reader) {
    const auto codes_there = reader.read(3);
    if (!codes_there) return Found::cut;
    code_count = *codes_there;
    if (code_count < least_codes || code_count > most_codes) return Found::bad;
    const auto count = reader.read(15);
    if (!count) return Found::cut;
    if (*count == 0) return Found::bad;
    selectors.clear();
    std::array<std::uint8_t, most_codes> order{0, 1, 2, 3, 4, 5};
    for (std::uint32_t i = 0; i < *count; ++i) {
        const auto place = static_cast<unsigned>(std::countl_one(reader.peek()));
        if (place >= code_count) {
            return reader.bits_left() < code_count ? Found::cut : Found::bad;
        }
        if (reader.bits_left() < place + 1) return Found::cut;
        reader.skip(place + 1);
        if (i >= most_groups) continue;
        const std::uint8_t code = order[place];
        for (unsigned at = place; at > 0; --at)
            order[at] = order[at - 1];
        order[0] = code;
        selectors.push_back(code);
    }
    return Found::good;
}

Found BlockTables::read_codes(BitReader& reader) {
    const std::size_t symbols = byte_count + 2;
    std::array<std::uint8_t, most_symbols> lengths{};
    for (unsigned code = 0; code < code_count; ++code) {
        const auto first = reader.read(5);
        if (!first) return Found::cut;
        unsigned length = *first;
        for (std::size_t symbol = 0; symbol < symbols; ++symbol) {
            for (;;) {
                if (length < 1 || length > most_code_bits) return Found::bad;
                const auto changes = reader.read(1);
                if (!changes) return Found::cut;
                if (*changes == 0) break;
                const auto shorter = reader.read(1);
                if (!shorter) return Found::cut;
                length = *shorter != 0 ? length - 1 : length + 1;
            }
            lengths[symbol] = static_cast<std::uint8_t>(length);
        }
        codes[code].build(std::span{lengths}.first(symbols));
    }
    return Found::good;
}

}  // namespace stormcellar::bunzip
