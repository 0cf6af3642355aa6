// stormcellar/level2/describe.h -- describes a decoded file as JSON, for `stormcellar info --json`.
//
// The fields have the names used in the reference descriptions of the real volumes (data/golden);
// tests/level2/golden_test.cpp compares describe() with these descriptions. "problems" holds the
// problems of the report. If a sweep has several SweepMoments of one name, because their geometry
// differs, one description covers them all, with the codes in the order of the radials.
//
// Threads   Pure functions.
// Errors    None.
// Accuracy  Counts and checksums are exact. Means come from exact counts of each code, in double.
#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {

struct FileFacts {
    std::string name;
    std::uint64_t size = 0;
};

// Describes a file. Strings are copied from the file unchanged, so they may not be UTF-8; the
// caller must allow for that when it writes the JSON.
[[nodiscard]] nlohmann::ordered_json describe(const Decoded& decoded, const FileFacts& file);

// Describes one element of the array "sweeps".
[[nodiscard]] nlohmann::ordered_json describe_sweep(const Sweep& sweep, std::size_t index);

}  // namespace stormcellar::level2
