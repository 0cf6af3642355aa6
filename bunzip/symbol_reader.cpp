#include "bunzip/symbol_reader.h"

#include <algorithm>

namespace stormcellar::bunzip {
namespace {

// Largest number of bits of a group, with the bytes that the last load reads beyond it.
constexpr std::uint64_t group_bits = group_symbols * most_code_bits + 128;
// Number of lookups between two loads. A load gives at least 56 bits.
constexpr unsigned lookups_a_load = 5;
static_assert(lookups_a_load * PrefixCode::lookup_bits <= 56);
static_assert(group_symbols % lookups_a_load == 0);

}  // namespace

std::span<const std::uint16_t> SymbolReader::next_batch() {
    std::uint16_t* to = batch_.data();
    for (std::size_t i = 0; i < batch_groups && !ended_ && found_ == Found::good; ++i) {
        if (group_ == tables_.selectors.size()) {
            found_ = Found::bad;
            break;
        }
        const PrefixCode& code = tables_.codes[tables_.selectors[group_++]];
        to = reader_.bits_left() >= group_bits ? read_group(code, to) : read_last_group(code, to);
    }
    return {batch_.data(), to};
}

// Reads a group far from the end of the bytes. `bits` holds the next bits, the first bit highest;
// `at` is their position in the stream. One load serves several lookups, so the usual symbol costs
// one lookup and one shift.
std::uint16_t* SymbolReader::read_group(const PrefixCode& code, std::uint16_t* to) {
    const std::byte* const bytes = reader_.bytes().data();
    const std::uint16_t* const lookup = code.lookup();
    const std::uint16_t end_symbol = tables_.end_symbol();
    std::uint64_t at = reader_.position();
    for (const std::uint16_t* const group_end = to + group_symbols; to != group_end;) {
        std::uint64_t bits = load_big_endian(bytes + at / 8) << (at % 8);
        for (unsigned i = 0; i < lookups_a_load; ++i) {
            const std::uint16_t entry = lookup[bits >> (64 - PrefixCode::lookup_bits)];
            unsigned length = entry & ((1U << PrefixCode::length_bits) - 1);
            std::uint16_t symbol = entry >> PrefixCode::length_bits;
            if (entry == 0) [[unlikely]] {
                // A long word can take more bits than the last load has left.
                bits = load_big_endian(bytes + at / 8) << (at % 8);
                const PrefixCode::Word word = code.decode(bits);
                length = word.length;
                symbol = word.symbol;
                ended_ = length != 0 && symbol == end_symbol;
                if (length == 0) found_ = Found::bad;
                if (ended_ || length == 0) {
                    reader_.move_to(at + length);
                    return to;
                }
                at += length;
                bits = load_big_endian(bytes + at / 8) << (at % 8);
                *to++ = symbol;
                if (to == group_end) break;
                continue;
            }
            *to++ = symbol;
            bits <<= length;
            at += length;
            if (to == group_end) break;
        }
    }
    reader_.move_to(at);
    return to;
}

// Reads a group near the end of the bytes, and checks each symbol.
std::uint16_t* SymbolReader::read_last_group(const PrefixCode& code, std::uint16_t* to) {
    for (std::size_t i = 0; i < group_symbols; ++i) {
        const PrefixCode::Word word = code.decode(reader_.peek());
        const unsigned known_after = word.length != 0 ? word.length : most_code_bits + 1;
        if (reader_.bits_left() < known_after) {
            found_ = Found::cut;
            return to;
        }
        if (word.length == 0) {
            found_ = Found::bad;
            return to;
        }
        reader_.skip(word.length);
        if (word.symbol == tables_.end_symbol()) {
            ended_ = true;
            return to;
        }
        *to++ = word.symbol;
    }
    return to;
}

}  // namespace stormcellar::bunzip
