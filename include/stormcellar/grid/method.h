// stormcellar/grid/method.h -- what a grid is made with: one rung of each step from antenna to
// cell.
//
// The steps, each from cheap to exact (docs/accuracy.md):
//   frame          where a column lies as the site sees it
//   beam           where a gate lies in the vertical plane of its azimuth
//   elevation      the sweep's one elevation (the median), or each radial's as measured
//   interpolation  which gates make up a point, and how much each counts
//   cell           a point at the cell's centre, or the mean over the cell
//   averaging      in the moment's own unit (dBZ), or in linear Z, which is what adds up
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/grid/beam_model.h"
#include "stormcellar/grid/chosen.h"

namespace stormcellar::grid {

enum class Interpolation {
    nearest,        // the nearest gate of the nearest sweep
    linear,         // nearest gate and radial, linear in height between sweeps
    eight_point,    // two gates of two radials in each of two sweeps, linear in all three
    beam_weighted,  // radials and sweeps by the antenna's pattern, linear in range
};
enum class CellExtent { point, area };
enum class Averaging { in_db, in_z };

using ChosenInterpolation = Chosen<Interpolation::linear, Interpolation::nearest>;
using ChosenExtent = Chosen<CellExtent::point, CellExtent::point>;
using ChosenAveraging = Chosen<Averaging::in_db, Averaging::in_db>;
using ChosenElevation = Chosen<true, false>;
using ChosenCircle = Chosen<true, false>;

// What a method's name says of its cells; point for a name that none has.
[[nodiscard]] CellExtent cell_extent_of(std::string_view method_name);

struct InterpolationFacts {
    Interpolation interpolation = Interpolation::nearest;
    std::string_view name = {};
    bool takes_one_gate = false;  // of each sweep, so that whole columns are filled at once
};
inline constexpr auto interpolation_facts = std::to_array<InterpolationFacts>({
    {Interpolation::nearest, "nearest", true},
    {Interpolation::linear, "linear", true},
    {Interpolation::eight_point, "eight-point"},
    {Interpolation::beam_weighted, "beam-weighted"},
});
[[nodiscard]] constexpr const InterpolationFacts& facts_of(Interpolation interpolation) {
    return interpolation_facts[static_cast<std::size_t>(interpolation)];
}
[[nodiscard]] std::string_view interpolation_name(Interpolation interpolation);
[[nodiscard]] std::optional<Interpolation> interpolation_from_name(std::string_view name);

struct Method {
    ChosenBeam beam = {};                    // the 4/3 earth unless said otherwise
    ChosenInterpolation interpolation = {};  // linear
    ChosenExtent cell = {};                  // a point
    ChosenAveraging averaging = {};  // in dB; reflectivity alone, other moments in their unit
    ChosenElevation radial_elevations = {};  // true: each radial's measured elevation
    // True: of moments that wrap; else their values are averaged as numbers.
    ChosenCircle on_circle = {};

    // "column-nearest", "column-linear", "eight-point", "beam-weighted", "area, beam-weighted".
    [[nodiscard]] std::string name() const;
    bool operator==(const Method&) const = default;
};

}  // namespace stormcellar::grid
