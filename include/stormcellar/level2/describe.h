// stormcellar/level2/describe.h -- a decoded file as facts: what `stormcellar info --json` prints.
//
// Names of fields are those of the reference descriptions beside the real volumes (data/golden),
// with which tests/level2/golden_test.cpp compares; "problems" holds the report's. Moments of one
// name that differ in geometry inside a sweep are described together, their codes in the order of
// the radials.
// Accuracy: counts and checksums exact; means from exact counts of each code, in double.
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

// Text that is not UTF-8 is the caller's to guard against when it writes the JSON.
[[nodiscard]] nlohmann::ordered_json describe(const Decoded& decoded, const FileFacts& file);

// The "sweeps" array's element alone.
[[nodiscard]] nlohmann::ordered_json describe_sweep(const Sweep& sweep, std::size_t index);

}  // namespace stormcellar::level2
