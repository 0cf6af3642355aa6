// stormcellar/grid/chosen.h -- a rung that the caller chooses, unless the library is built for one
// chain alone.
//
// In a normal build the library has every rung of every step, and a Chosen is a value like any
// other. To count the cost of the choice itself, scripts/check-costs builds the library without it,
// with -DSTORMCELLAR_CHAIN=
//   usual     the default chain, without any effect that is off by default
//   cheapest  every effect off: flat earth, one elevation for each sweep, nearest, a point, on a
//             sphere
// In these builds a Chosen is a constant, so the compiler drops every other rung and every test of
// which rung it is. Such a library is only for counting: it aborts if another rung is asked for.
//
// Threads   Plain values.
// Errors    None, but for the abort in the builds for counting.
#pragma once

#include <cstdlib>

namespace stormcellar::grid {

// A Chosen converts to and from its rung: NOLINTBEGIN(google-explicit-constructor)
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
