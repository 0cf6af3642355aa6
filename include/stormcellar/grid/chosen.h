// stormcellar/grid/chosen.h -- a rung that the caller chooses, unless the library is built with one
// chain alone.
//
// As released the library has every rung of every step, and a Chosen is a value like any other. To
// count what the choice itself costs (scripts/check-costs) the library is built without it, with
// -DSTORMCELLAR_CHAIN=
//   usual     the default chain: what DESIGN section 6 calls a build without what is off by default
//   cheapest  every effect off: flat earth, one elevation a sweep, nearest, a point, on a sphere
// A Chosen is a constant then, and the compiler drops every rung that it is not and every question
// which it is. Such a library is for counting: it aborts where another rung is asked for.
// Threads: plain values.
#pragma once

#include <cstdlib>

namespace stormcellar::grid {

// A Chosen stands for its rung: NOLINTBEGIN(google-explicit-constructor)
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
    // Whether the library is built with this rung.
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
