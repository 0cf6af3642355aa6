#include "level2/decode/sweep_rows.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

namespace stormcellar::level2::rows {
namespace {

constexpr std::size_t reserve_limit_bytes = std::size_t{4} << 20;

// Calls the function with codes8 or codes16, by the word size of the moment.
template <class Function>
void with_codes(SweepMoment& moment, Function function) {
    if (moment.word_size_bits == 8) {
        function(moment.codes8);
    } else {
        function(moment.codes16);
    }
}

// An array that is larger than any known sweep grows by a quarter instead of doubling, because many
// such sweeps may be open at once.
template <class Code>
void make_room(std::vector<Code>& codes, std::size_t more) {
    const std::size_t wanted = codes.size() + more;
    if (wanted <= codes.capacity() || wanted * sizeof(Code) <= reserve_limit_bytes) return;
    codes.reserve(std::max(wanted, codes.size() + codes.size() / 4));
}

template <class Code>
void append_rows(std::vector<Code>& codes, std::size_t stride, const std::vector<Code>& from,
                 std::size_t from_stride) {
    if (stride == from_stride) {
        codes.insert(codes.end(), from.begin(), from.end());
        return;
    }
    for (std::size_t at = 0; at < from.size(); at += from_stride) {
        const auto row = from.begin() + static_cast<std::ptrdiff_t>(at);
        codes.insert(codes.end(), row, row + static_cast<std::ptrdiff_t>(from_stride));
        codes.resize(codes.size() + stride - from_stride);
    }
}

// Shortens rows that are longer than needed, and frees most of the unused memory.
void release_unused(SweepMoment& moment) {
    const auto largest = *std::max_element(moment.gate_counts.begin(), moment.gate_counts.end());
    if (largest < moment.gate_stride) set_stride(moment, largest);
    with_codes(moment, [](auto& codes) {
        if (codes.capacity() - codes.size() > codes.size() / 8) codes.shrink_to_fit();
    });
    if (moment.gate_counts.capacity() > 2 * moment.gate_counts.size()) {
        moment.gate_counts.shrink_to_fit();
    }
}

std::uint16_t native_from_big_endian(std::uint16_t number) {
    static_assert(std::endian::native == std::endian::little);
    return static_cast<std::uint16_t>((number >> 8) | (number << 8));
}

// Compares the members that MomentBlock and SweepMoment both have, under equal names.
template <class Described>
bool is_same_kind(const SweepMoment& a, const Described& b) {
    return a.moment == b.moment && a.first_gate_m == b.first_gate_m &&
           a.gate_spacing_m == b.gate_spacing_m && a.word_size_bits == b.word_size_bits &&
           a.scale == b.scale && a.offset == b.offset;
}

template <class Described>
SweepMoment described_by(const Described& from, std::int32_t stride) {
    SweepMoment moment;
    moment.moment = from.moment;
    moment.first_gate_m = from.first_gate_m;
    moment.gate_spacing_m = from.gate_spacing_m;
    moment.gate_stride = stride;
    moment.word_size_bits = from.word_size_bits;
    moment.scale = from.scale;
    moment.offset = from.offset;
    moment.control_flags = from.control_flags;
    moment.snr_threshold_db = from.snr_threshold_db;
    moment.folding_threshold_db = from.folding_threshold_db;
    return moment;
}

}  // namespace

bool same_kind(const SweepMoment& moment, const MomentBlock& block) {
    return is_same_kind(moment, block);
}

bool same_kind(const SweepMoment& a, const SweepMoment& b) {
    return is_same_kind(a, b);
}

SweepMoment empty_like(const MomentBlock& block) {
    return described_by(block, block.gates);
}

SweepMoment empty_like(const SweepMoment& moment) {
    return described_by(moment, moment.gate_stride);
}

std::uint64_t bytes_per_code(const SweepMoment& moment) {
    return moment.word_size_bits == 8 ? 1 : 2;
}

void reserve(SweepMoment& moment, std::size_t rows) {
    const std::size_t most = reserve_limit_bytes / bytes_per_code(moment);
    moment.gate_counts.reserve(rows);
    const std::size_t codes_wanted = rows * static_cast<std::size_t>(moment.gate_stride);
    with_codes(moment, [&](auto& codes) { codes.reserve(std::min(codes_wanted, most)); });
}

void set_stride(SweepMoment& moment, std::int32_t stride) {
    const auto from = static_cast<std::size_t>(moment.gate_stride);
    const auto to = static_cast<std::size_t>(stride);
    with_codes(moment, [&](auto& codes) {
        std::remove_reference_t<decltype(codes)> moved(moment.gate_counts.size() * to);
        for (std::size_t row = 0; row < moment.gate_counts.size(); ++row) {
            const auto begin = codes.begin() + static_cast<std::ptrdiff_t>(row * from);
            std::copy(begin, begin + static_cast<std::ptrdiff_t>(std::min(from, to)),
                      moved.begin() + static_cast<std::ptrdiff_t>(row * to));
        }
        codes = std::move(moved);
    });
    moment.gate_stride = stride;
}

std::int32_t grown_stride(const SweepMoment& moment, std::int32_t gates) {
    if (moment.gate_counts.empty()) return gates;
    return std::max(gates, moment.gate_stride + moment.gate_stride / 4);
}

void pad(SweepMoment& moment, std::size_t rows) {
    if (moment.gate_counts.size() >= rows) return;
    moment.gate_counts.resize(rows);
    with_codes(moment, [&](auto& codes) {
        codes.resize(rows * static_cast<std::size_t>(moment.gate_stride));
    });
}

void append(SweepMoment& moment, const MomentBlock& block) {
    const auto stride = static_cast<std::size_t>(moment.gate_stride);
    const std::size_t row = moment.gate_counts.size() * stride;
    moment.gate_counts.push_back(block.gates);
    if (moment.word_size_bits == 8) {
        const auto* codes = reinterpret_cast<const std::uint8_t*>(block.codes.data());
        moment.codes8.insert(moment.codes8.end(), codes, codes + block.gates);
        moment.codes8.resize(row + stride);
        return;
    }
    moment.codes16.resize(row + stride);
    std::uint16_t* codes = moment.codes16.data() + row;
    std::memcpy(codes, block.codes.data(), sizeof(std::uint16_t) * block.gates);
    for (std::size_t gate = 0; gate < block.gates; ++gate)
        codes[gate] = native_from_big_endian(codes[gate]);
}

void append(SweepMoment& moment, const SweepMoment& from) {
    const auto stride = static_cast<std::size_t>(moment.gate_stride);
    const auto from_stride = static_cast<std::size_t>(from.gate_stride);
    moment.gate_counts.insert(moment.gate_counts.end(), from.gate_counts.begin(),
                              from.gate_counts.end());
    with_codes(moment, [&](auto& codes) { make_room(codes, from.gate_counts.size() * stride); });
    if (moment.word_size_bits == 8) {
        append_rows(moment.codes8, stride, from.codes8, from_stride);
    } else {
        append_rows(moment.codes16, stride, from.codes16, from_stride);
    }
}

namespace {

// Returns the first row with gates in [first, end), counted from `first`; end - first if there is
// none.
std::size_t first_row_with_gates(const SweepMoment& moment, std::size_t first, std::size_t end) {
    const auto begin = moment.gate_counts.begin() + static_cast<std::ptrdiff_t>(first);
    const auto stop = moment.gate_counts.begin() + static_cast<std::ptrdiff_t>(end);
    const auto with_gates =
        std::find_if(begin, stop, [](std::uint16_t gates) { return gates > 0; });
    return static_cast<std::size_t>(with_gates - begin);
}

template <class Array>
Array rows_of(const Array& from, std::size_t first, std::size_t end, std::size_t stride) {
    return Array(from.begin() + static_cast<std::ptrdiff_t>(first * stride),
                 from.begin() + static_cast<std::ptrdiff_t>(end * stride));
}

template <class Array>
void rotate_rows(Array& array, std::size_t count, std::size_t at, std::size_t stride) {
    std::rotate(array.begin() + static_cast<std::ptrdiff_t>(at * stride),
                array.end() - static_cast<std::ptrdiff_t>(count * stride), array.end());
}

}  // namespace

Sweep part_of(Sweep& sweep, std::size_t first, std::size_t end) {
    Sweep part;
    part.elevation_number = sweep.elevation_number;
    part.message_type = sweep.message_type;
    part.azimuth_spacing_deg = sweep.azimuth_spacing_deg;
    part.radials = rows_of(sweep.radials, first, end, 1);
    // Kinds are in the order in which they first occur in the radials of this part.
    std::vector<std::pair<std::size_t, const SweepMoment*>> kinds;
    for (SweepMoment& moment : sweep.moments) {
        pad(moment, sweep.radials.size());
        const std::size_t row = first_row_with_gates(moment, first, end);
        if (row < end - first) kinds.emplace_back(row, &moment);
    }
    std::ranges::stable_sort(kinds, {}, [](const auto& kind) { return kind.first; });
    for (const auto& kind : kinds) {
        const SweepMoment* const moment = kind.second;
        SweepMoment& own = part.moments.emplace_back(empty_like(*moment));
        own.gate_counts = rows_of(moment->gate_counts, first, end, 1);
        with_codes(own, [&](auto& codes) {
            const auto stride = static_cast<std::size_t>(moment->gate_stride);
            if constexpr (sizeof(codes[0]) == 1) {
                codes = rows_of(moment->codes8, first, end, stride);
            } else {
                codes = rows_of(moment->codes16, first, end, stride);
            }
        });
        // Shorten the rows to the longest row of the part, as in a sweep that consists of these
        // rows.
        const auto longest = *std::max_element(own.gate_counts.begin(), own.gate_counts.end());
        if (longest < own.gate_stride) set_stride(own, longest);
    }
    return part;
}

void move_last_rows(Sweep& sweep, std::size_t count, std::size_t at) {
    rotate_rows(sweep.radials, count, at, 1);
    for (SweepMoment& moment : sweep.moments) {
        pad(moment, sweep.radials.size());
        rotate_rows(moment.gate_counts, count, at, 1);
        with_codes(moment, [&](auto& codes) {
            rotate_rows(codes, count, at, static_cast<std::size_t>(moment.gate_stride));
        });
    }
}

std::uint64_t idle_bytes(const SweepMoment& moment) {
    const std::uint64_t capacity =
        moment.codes8.capacity() + sizeof(std::uint16_t) * moment.codes16.capacity();
    const std::uint64_t used = moment.codes8.size() + sizeof(std::uint16_t) * moment.codes16.size();
    return capacity <= reserve_limit_bytes ? 0 : capacity - used;
}

void make_whole(Sweep& sweep) {
    for (SweepMoment& moment : sweep.moments) {
        pad(moment, sweep.radials.size());
        release_unused(moment);
    }
    if (sweep.radials.capacity() > 2 * sweep.radials.size()) sweep.radials.shrink_to_fit();
}

}  // namespace stormcellar::level2::rows
