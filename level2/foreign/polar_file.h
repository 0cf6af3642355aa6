// level2/foreign/polar_file.h -- what a file of another format says about a volume before its gates
// are read.
//
// Threads   Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arrayfile/array_file.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// The elements of an array that are the gates of one radial.
struct GateRow {
    std::size_t first = 0;  // index of the first element
    std::uint32_t gates = 0;
};

// The gates of one moment of one sweep, as the file has them.
struct MomentSource {
    Moment moment = Moment::ref;
    const arrayfile::Array* array = nullptr;
    const arrayfile::Array* states = nullptr;  // a GateStatus for each element; null: none
    // value = element * gain + offset
    double gain = 1;
    double offset = 0;
    std::vector<double> missing;  // elements that mean: not measured
    std::vector<double> below;    // elements that mean: below threshold; also NaN
    double first_gate_m = 0;      // to the center
    double gate_spacing_m = 0;
    std::size_t step = 1;       // elements of the array for each gate
    std::vector<GateRow> rows;  // one for each radial
    // True if a moment without any value was not measured, and so is left out.
    bool is_left_out_if_empty = false;
    // The packing of a file that this program wrote; none: chosen by the elements.
    struct KnownPacking {
        float scale = 1, offset = 0;
        int word_size_bits = 8;
    };
    std::optional<KnownPacking> packing;
};

struct PolarSweep {
    Sweep sweep;  // with its radials, without moments
    std::vector<MomentSource> sources;
};

struct PolarFile {
    std::string format;   // "ODIM_H5/V2_2", "CfRadial 1.4"
    std::string station;  // four letters; or empty
    std::string source;   // the name of the radar, as in the file
    VolumeBlock block;
    std::optional<int> vcp;
    bool is_partial = false;
    std::vector<PolarSweep> sweeps;
    std::vector<std::string> left_out;  // quantities that no moment has room for
};

}  // namespace stormcellar::level2
