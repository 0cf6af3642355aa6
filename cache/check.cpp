#include "cache/check.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>

#include "cache/format.h"
#include "grid/sweep/sweep_clock.h"

namespace stormcellar::cache {
namespace {

using grid::BrickEntry;
using grid::BrickKind;
using grid::CellStatus;

bool time_is_possible(UtcTime time) {
    using namespace std::chrono;
    static constexpr UtcTime first{};
    static constexpr UtcTime last = sys_days{year{10000} / 1 / 1} - milliseconds{1};
    return first <= time && time <= last;
}

bool is_finite(const grid::SitePosition& site) {
    return std::isfinite(site.latitude_deg) && std::isfinite(site.longitude_deg) &&
           std::isfinite(site.altitude_m);
}

bool is_possible(const grid::SweepTime& sweep) {
    return std::abs(sweep.elevation_deg) <= 90 && time_is_possible(sweep.start) &&
           sweep.first_azimuth_deg >= 0 && sweep.first_azimuth_deg <= 360 &&
           sweep.degrees_per_s >= 0 && sweep.degrees_per_s <= grid::fastest_turn_deg_per_s;
}

bool is_possible(const grid::Quantization& quantization) {
    return (quantization.code_bytes == 1 || quantization.code_bytes == 2) &&
           std::isfinite(quantization.first_value) && std::isfinite(quantization.step) &&
           quantization.step > 0;
}

bool is_uniform_form(const BrickEntry& entry) {
    return entry.uniform_status <= CellStatus::range_folded && entry.value_count == 0 &&
           entry.min_code == 0 && entry.max_code == 0 && entry.status_index == 0 &&
           entry.checksum == 0;
}

bool is_status_only_form(const BrickEntry& entry, std::uint64_t next_block) {
    return entry.uniform_status == CellStatus::not_seen && entry.value_count == 0 &&
           entry.min_code == 0 && entry.max_code == 0 && entry.status_index == next_block;
}

bool is_stored_form(const BrickEntry& entry, const grid::Quantization& quantization) {
    return entry.uniform_status == CellStatus::not_seen && entry.status_index == 0 &&
           entry.value_count >= 1 && entry.value_count <= grid::brick_cells &&
           entry.min_code >= grid::first_value_code && entry.min_code <= entry.max_code &&
           entry.max_code <= quantization.largest_code();
}

// Returns true if some cell has both bits set, which means that it has a value. Tests all cells,
// because the compiler vectorizes such a loop.
bool claims_a_value(std::span<const std::byte> states) {
    constexpr std::byte low_bits{0x55};
    std::byte both{};
    for (const std::byte four_cells : states)
        both |= four_cells & (four_cells >> 1) & low_bits;
    return both != std::byte{};
}

template <class Code>
CodeRange range_of(std::span<const std::byte> bytes) {
    CodeRange range;
    for (std::size_t at = 0; at + sizeof(Code) <= bytes.size(); at += sizeof(Code)) {
        Code code = 0;
        std::memcpy(&code, bytes.data() + at, sizeof code);
        if (code < grid::first_value_code) continue;
        range.min_code =
            range.value_count == 0 ? code : std::min<std::uint16_t>(range.min_code, code);
        range.max_code = std::max<std::uint16_t>(range.max_code, code);
        ++range.value_count;
    }
    return range;
}

}  // namespace

std::uint64_t brick_count(const grid::GridSpec& spec) {
    return static_cast<std::uint64_t>(grid::bricks_along(spec.nx)) *
           static_cast<std::uint64_t>(grid::bricks_along(spec.ny)) *
           static_cast<std::uint64_t>(grid::bricks_along(spec.nz()));
}

Status check_description(const GridDescription& description,
                         const grid::Quantization& quantization) {
    if (Status valid = grid::validate(description.spec); !valid) {
        return fail(ErrorCode::corrupt, "{}", valid.error().message);
    }
    if (brick_count(description.spec) > format::max_bricks) {
        return fail(ErrorCode::corrupt, "{} bricks, more than the {} of the format",
                    brick_count(description.spec), format::max_bricks);
    }
    if (static_cast<int>(description.moment) >= level2::moment_count) {
        return fail(ErrorCode::corrupt, "no moment has the number {}",
                    static_cast<int>(description.moment));
    }
    if (!is_possible(quantization)) {
        return fail(ErrorCode::corrupt, "impossible quantization: {} bytes, from {} by {}",
                    quantization.code_bytes, quantization.first_value, quantization.step);
    }
    for (const UtcTime time : {description.time, description.start_time, description.end_time}) {
        if (!time_is_possible(time)) {
            return fail(ErrorCode::corrupt, "a time is outside the years 1970 to 9999");
        }
    }
    if (!std::all_of(description.sites.begin(), description.sites.end(), is_finite)) {
        return fail(ErrorCode::corrupt, "a site's position is not a number");
    }
    const auto& sweeps = description.provenance.sweeps;
    if (!std::all_of(sweeps.begin(), sweeps.end(),
                     [](const grid::SweepTime& sweep) { return is_possible(sweep); })) {
        return fail(ErrorCode::corrupt, "a sweep has an impossible angle, time or speed");
    }
    return {};
}

Status check_bricks(std::span<const BrickEntry> bricks, std::span<const std::byte> states,
                    const grid::Quantization& quantization, Packing packing) {
    const std::uint64_t brick_bytes =
        grid::brick_cells * static_cast<std::uint64_t>(quantization.code_bytes);
    std::uint64_t blocks = 0;
    for (std::size_t i = 0; i < bricks.size(); ++i) {
        const BrickEntry& entry = bricks[i];
        const bool is_packed = packing != Packing::none && entry.kind == BrickKind::stored;
        bool good = is_packed ? entry.packed_bytes >= 1 && entry.packed_bytes <= brick_bytes
                              : entry.packed_bytes == 0;
        switch (entry.kind) {
            case BrickKind::uniform:
                good = good && is_uniform_form(entry);
                break;
            case BrickKind::status_only:
                good = good && is_status_only_form(entry, blocks++);
                break;
            case BrickKind::stored:
                good = good && is_stored_form(entry, quantization);
                break;
            default:
                good = false;
        }
        if (!good) return fail(ErrorCode::corrupt, "the entry of brick {} is impossible", i);
    }
    if (states.size() != blocks * format::status_block_bytes) {
        return fail(ErrorCode::corrupt, "{} bytes of states for {} bricks that need them",
                    states.size(), blocks);
    }
    if (claims_a_value(states)) {
        return fail(ErrorCode::corrupt, "a brick without values claims to have one");
    }
    return {};
}

std::uint64_t packed_size(std::span<const BrickEntry> bricks) {
    return std::accumulate(
        bricks.begin(), bricks.end(), std::uint64_t{0},
        [](std::uint64_t sum, const BrickEntry& entry) { return sum + entry.packed_bytes; });
}

CodeRange code_range(std::span<const std::byte> codes, int code_bytes) {
    return code_bytes == 1 ? range_of<std::uint8_t>(codes) : range_of<std::uint16_t>(codes);
}

}  // namespace stormcellar::cache
