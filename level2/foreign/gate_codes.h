// level2/foreign/gate_codes.h -- packs gates of other formats into the codes of a SweepMoment.
//
// Code 0 is below threshold and code 1 range folded. Integers of the file stay as they are, or all
// move by the same number, so they keep their values exactly (as far as float holds scale and
// offset). Floats, and integers with too large a range, become 16-bit codes in steps of 0.01 of the
// unit (RHO: 0.0001), so they move by at most half a step.
//
// A Volume has no code for a gate that was not measured. Such gates at the end of a radial are cut
// off; those at the start of all radials move the first gate; any other such gate becomes range
// folded, which also means that the value is unknown. If the length of gates is no whole number of
// meters, gates of the nearest whole length take the values of the nearest gates of the file.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <optional>

#include "arrayfile/array_file.h"
#include "level2/foreign/polar_file.h"
#include "stormcellar/base/result.h"

namespace stormcellar::level2 {

struct Packing {
    bool is_exact = true;
    std::int64_t shift = 0;  // if exact: code = element + shift
    float scale = 1, offset = 0;
    int word_size_bits = 8;
};

// Chooses the packing of an array.
[[nodiscard]] Packing choose_packing(const MomentSource& source,
                                     const arrayfile::Elements& elements);

struct PackedMoment {
    std::optional<SweepMoment> moment;  // none if no gate was measured
    std::uint64_t gaps = 0;             // gates without a measurement between measured gates
    std::uint64_t beyond = 0;           // values that no code can express; given as not measured
};

// Packs the gates of a sweep. `states` may be null. Errors: corrupt if rows reach beyond the
// elements, or the gates have no sensible length; unsupported for more than 65,535 gates.
[[nodiscard]] Result<PackedMoment> pack_gates(const MomentSource& source, const Packing& packing,
                                              const arrayfile::Elements& elements,
                                              const arrayfile::Elements* states);

}  // namespace stormcellar::level2
