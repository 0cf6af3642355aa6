// tests/hard_cases/mutant.h -- describes a damaged file, and the radials that must still be read
// from it.
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
    beside,    // directly after damage without a checksum: returned unchanged, or not at all
    damaged    // changed, without a checksum: returned once with any content, or not at all
};

struct ExpectedRadial {
    std::optional<std::size_t> radial;  // number in the undamaged volume; none: no radial
    Fate fate = Fate::kept;
};

struct Mutant {
    std::string kind;  // kind of damage, by which figures are counted
    std::string what;  // description of the damage for a person
    wire::Bytes file;
    std::vector<ExpectedRadial> expected;  // in the order of the volume
    // True if the damage changed a length or type, which the report must name even if every radial
    // is kept.
    bool always_named = false;
    // True if no checksum guards the rest of the file, so that other radials may follow.
    bool anything_after = false;
};

// Sorts the expected radials and removes repeated ones, as the decoder does with late and repeated
// radials.
inline void put_in_order(std::vector<ExpectedRadial>& expected) {
    std::ranges::sort(expected, {}, &ExpectedRadial::radial);
    const auto is_same = [](const ExpectedRadial& a, const ExpectedRadial& b) {
        return a.radial == b.radial;
    };
    expected.erase(std::unique(expected.begin(), expected.end(), is_same), expected.end());
}

// Returns a random number below `limit`, or 0 if `limit` is 0.
inline std::size_t below(std::mt19937_64& random, std::size_t limit) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(limit, 1));
}

}  // namespace stormcellar::level2
