// web/data/grids/packed_sweep.h -- the gates of one moment of one sweep, packed for browsers.
//
// docs/web/packed-grid.md specifies the bytes, and the structs below assert them.
//
// Threads   Pure functions.
// Errors    See pack_sweep().
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::web {

inline constexpr std::array<unsigned char, 8> packed_sweep_magic = {0x89, 'S',  'C',  'W',
                                                                    '\r', '\n', 0x1A, '\n'};

struct PackedSweepHeader {
    std::array<unsigned char, 8> magic = packed_sweep_magic;
    std::uint32_t version = 1;
    std::uint32_t header_size = 128;
    std::uint64_t size = 0;
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;  // NaN: unknown
    std::uint32_t moment = 0;
    std::uint32_t sweep = 0;             // its number in the volume, from 0
    std::uint32_t elevation_number = 0;  // the cut of the VCP, from 1
    float elevation_deg = 0;             // mean of the radials
    std::uint32_t kind = 0, kind_count = 0;
    std::uint32_t radial_count = 0;
    std::uint32_t gate_stride = 0;  // codes in a row
    std::int32_t first_gate_m = 0;  // slant range to the center of gate 0
    std::int32_t gate_spacing_m = 0;
    std::uint32_t code_bytes = 1;
    std::uint32_t first_valid_code = 2;  // smaller codes are states and flags
    float scale = 1, offset = 0;         // value = (code - offset) / scale
    std::uint64_t radials_offset = 0;
    std::uint64_t codes_offset = 0;
    // Gates with a lesser probability of weather are left out; 0: all gates are here.
    float least_probability = 0;
    float left_out_share = 0;  // of the sweep's gates with echo
};
static_assert(sizeof(PackedSweepHeader) == 128);
static_assert(offsetof(PackedSweepHeader, version) == 8);
static_assert(offsetof(PackedSweepHeader, header_size) == 12);
static_assert(offsetof(PackedSweepHeader, size) == 16);
static_assert(offsetof(PackedSweepHeader, latitude_deg) == 24);
static_assert(offsetof(PackedSweepHeader, longitude_deg) == 32);
static_assert(offsetof(PackedSweepHeader, altitude_m) == 40);
static_assert(offsetof(PackedSweepHeader, moment) == 48);
static_assert(offsetof(PackedSweepHeader, sweep) == 52);
static_assert(offsetof(PackedSweepHeader, elevation_number) == 56);
static_assert(offsetof(PackedSweepHeader, elevation_deg) == 60);
static_assert(offsetof(PackedSweepHeader, kind) == 64);
static_assert(offsetof(PackedSweepHeader, kind_count) == 68);
static_assert(offsetof(PackedSweepHeader, radial_count) == 72);
static_assert(offsetof(PackedSweepHeader, gate_stride) == 76);
static_assert(offsetof(PackedSweepHeader, first_gate_m) == 80);
static_assert(offsetof(PackedSweepHeader, gate_spacing_m) == 84);
static_assert(offsetof(PackedSweepHeader, code_bytes) == 88);
static_assert(offsetof(PackedSweepHeader, first_valid_code) == 92);
static_assert(offsetof(PackedSweepHeader, scale) == 96);
static_assert(offsetof(PackedSweepHeader, offset) == 100);
static_assert(offsetof(PackedSweepHeader, radials_offset) == 104);
static_assert(offsetof(PackedSweepHeader, codes_offset) == 112);
static_assert(offsetof(PackedSweepHeader, least_probability) == 120);
static_assert(offsetof(PackedSweepHeader, left_out_share) == 124);

struct PackedRadial {
    std::int64_t time_ms = 0;
    float azimuth_deg = 0, elevation_deg = 0;
    float nyquist_mps = 0;  // 0: unknown
    float unambiguous_range_m = 0;
    std::uint32_t gate_count = 0;  // 0: the radial lacks the moment
    std::uint32_t reserved = 0;
};
static_assert(sizeof(PackedRadial) == 32);
static_assert(offsetof(PackedRadial, azimuth_deg) == 8);
static_assert(offsetof(PackedRadial, elevation_deg) == 12);
static_assert(offsetof(PackedRadial, nyquist_mps) == 16);
static_assert(offsetof(PackedRadial, unambiguous_range_m) == 20);
static_assert(offsetof(PackedRadial, gate_count) == 24);

// The echo that a volume lacks because it is probably no weather.
struct LackingEcho {
    double least_probability = 0;
    const level2::Volume* all = nullptr;  // the volume with all echo; null: it lacks none
};

// Returns the bytes. A sweep may have several arrays of one moment, with different gates; `kind` is
// the index of the array. Errors: not_found if the volume has no such sweep, moment or array.
[[nodiscard]] Result<std::string> pack_sweep(const level2::Volume& volume, std::size_t sweep,
                                             level2::Moment moment, std::size_t kind,
                                             const LackingEcho& lacking = {});

}  // namespace stormcellar::web
