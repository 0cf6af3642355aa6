// tests/hard_cases/mutant.h -- a damaged file, and what must still be read from it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/level2/wire.h"

namespace stormcellar::level2 {

// The fates that a radial of the undamaged volume may have.
enum class Fate {
    kept,      // outside the damage: returned unchanged
    may_fall,  // shares a checksum with damaged bytes: returned unchanged, or not at all
    beside,    // directly after damage that nothing guards: as above
    damaged    // its own bytes are changed and nothing guards them: anything, once, or nothing
};

struct ExpectedRadial {
    std::optional<std::size_t> radial;  // its number in the undamaged volume; none: no radial
    Fate fate = Fate::kept;
};

struct Mutant {
    std::string kind;  // figures are counted for each
    std::string what;  // for a person who has to reproduce it
    wire::Bytes file;
    std::vector<ExpectedRadial> expected;  // in the order of the volume
    // True if the damage changed a length or type, which the report must name even if every radial
    // is kept.
    bool always_named = false;
    bool anything_after = false;  // nothing guards the rest of the file
};

// Sorts the expected radials: one that comes late or twice is returned once, where it belongs.
inline void put_in_order(std::vector<ExpectedRadial>& expected) {
    std::ranges::sort(expected, {}, &ExpectedRadial::radial);
    const auto is_same = [](const ExpectedRadial& a, const ExpectedRadial& b) {
        return a.radial == b.radial;
    };
    expected.erase(std::unique(expected.begin(), expected.end(), is_same), expected.end());
}

// Returns a whole number below `limit`; 0 if there is none.
inline std::size_t below(std::mt19937_64& random, std::size_t limit) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(limit, 1));
}

}  // namespace stormcellar::level2
