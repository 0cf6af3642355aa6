// stormcellar/level2/describe.h -- describes a decoded file as facts: the output of `stormcellar
// info --json`.
//
// The names of fields are those of the reference descriptions beside the real volumes
// (data/golden), with which tests/level2/golden_test.cpp compares the result. "problems" holds the
// problems of the report. If moments of one name differ in geometry inside a sweep, they are
// described together, with their codes in the order of the radials.
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

// Describes a file. Strings are copied from the file as they are; the caller must expect text that
// is not UTF-8 when it writes the JSON.
[[nodiscard]] nlohmann::ordered_json describe(const Decoded& decoded, const FileFacts& file);

// Describes one element of the array "sweeps".
[[nodiscard]] nlohmann::ordered_json describe_sweep(const Sweep& sweep, std::size_t index);

}  // namespace stormcellar::level2
