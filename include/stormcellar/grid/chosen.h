// stormcellar/grid/chosen.h -- a rung (one form of a step, stormcellar/grid/method.h) that the
// caller chooses, unless the library is built for a single chain (one rung for each step).
//
// In a normal build the library has every rung of every step, and a Chosen is an ordinary value.
// scripts/check-costs counts the cost of the choice itself, so it also builds the library without
// choices, with -DSTORMCELLAR_CHAIN=
//   usual     the default chain, without any effect that is off by default
//   cheapest  every effect off: beams over a flat earth, one elevation for each sweep, the nearest
//             gate, each cell as a point, azimuth and arc of columns computed on a sphere
// In these builds a Chosen is a constant, so the compiler drops all other rungs and all tests of
// the rung. Such a library serves only for counting costs, because it aborts if a caller chooses
// another rung.
//
// Threads   Plain values.
// Errors    None; only the builds for counting abort.
#pragma once

#include <cstdlib>

namespace stormcellar::grid {

// NOLINTBEGIN(google-explicit-constructor): a Chosen converts to and from its rung.
#if defined(STORMCELLAR_USUAL_CHAIN) || defined(STORMCELLAR_CHEAPEST_CHAIN)

template <auto usual, auto cheapest>
class Chosen {
  public:
    using Rung = decltype(usual);
#ifdef STORMCELLAR_USUAL_CHAIN
    static constexpr Rung built = usual;
#else
    static constexpr Rung built = cheapest;
#endif
    [[nodiscard]] static constexpr bool can_be(Rung rung) {
        return rung == built;
    }

    constexpr Chosen() = default;
    constexpr Chosen(Rung rung) {
        if (rung != built) std::abort();
    }
    constexpr operator Rung() const {
        return built;
    }
};

#else

template <auto usual, auto cheapest>
class Chosen {
  public:
    using Rung = decltype(usual);
    // Returns true if the library is built with this rung.
    [[nodiscard]] static constexpr bool can_be(Rung) { return true; }

    constexpr Chosen() = default;
    constexpr Chosen(Rung rung) : rung_(rung) {}
    constexpr operator Rung() const { return rung_; }

  private:
    Rung rung_ = usual;
};

#endif
// NOLINTEND(google-explicit-constructor)

}  // namespace stormcellar::grid
