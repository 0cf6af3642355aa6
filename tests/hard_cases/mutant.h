// tests/hard_cases/mutant.h -- a damaged file, and what must still come out of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/level2/wire.h"

namespace stormcellar::level2 {

// What may become of a radial of the undamaged volume.
enum class Fate {
    kept,      // outside the damage: comes out to the bit
    may_fall,  // shares a checksum with damaged bytes: comes out to the bit or not at all
    beside,    // right behind damage that nothing guards: as above
    damaged    // its own bytes are changed and nothing guards them: anything, once, or nothing
};

struct ExpectedRadial {
    std::optional<std::size_t> radial;  // its number in the undamaged volume; none: no radial
    Fate fate = Fate::kept;
};

struct Mutant {
    std::string kind;  // figures are kept for each
    std::string what;  // for a person who has to repeat it
    wire::Bytes file;
    std::vector<ExpectedRadial> expected;  // in the order of the file
    // Whether a changed length or type lies in the damage, which the report must name even where
    // every radial is kept.
    bool always_named = false;
    bool anything_after = false;  // nothing guards the rest of the file
};

// Any whole number below `limit`; 0 where there is none.
inline std::size_t below(std::mt19937_64& random, std::size_t limit) {
    return static_cast<std::size_t>(random() % std::max<std::size_t>(limit, 1));
}

}  // namespace stormcellar::level2
