// stormcellar/grid/method.h -- how a grid is made: one rung for each step from the antenna to the
// cell.
//
// Each step has rungs from cheap to exact (docs/accuracy.md):
//   frame          how azimuth and arc of a column are found (not in Method; see ColumnGeometry)
//   beam           where a gate is in the vertical plane of its azimuth
//   elevation      one elevation for the sweep (the median), or the measured one of each radial
//   interpolation  which gates make up a point, and how much each counts
//   cell           a point at the center of the cell, or the mean over the cell
//   averaging      in the moment's own unit (dBZ), or in linear Z, which is proportional to power
//
// Threads   Plain values and pure functions.
// Errors    None; an unknown name gives none.
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

// Returns the cell extent of a method by its name, which Method::name() wrote. Returns point for an
// unknown name.
[[nodiscard]] CellExtent cell_extent_of(std::string_view method_name);

// Facts about an interpolation. CONTRIBUTING.md says how to add one.
struct InterpolationFacts {
    Interpolation interpolation = Interpolation::nearest;
    std::string_view name = {};
    bool takes_one_gate = false;  // of each sweep, so whole columns are filled at once
    bool is_by_pattern = false;   // more sweeps than the two around a level may count
};
inline constexpr auto interpolation_facts = std::to_array<InterpolationFacts>({
    {Interpolation::nearest, "nearest", true},
    {Interpolation::linear, "linear", true},
    {Interpolation::eight_point, "eight-point"},
    {Interpolation::beam_weighted, "beam-weighted", false, true},
});
[[nodiscard]] constexpr const InterpolationFacts& facts_of(Interpolation interpolation) {
    return interpolation_facts[static_cast<std::size_t>(interpolation)];
}
// Returns "nearest", "linear", "eight-point" or "beam-weighted".
[[nodiscard]] std::string_view interpolation_name(Interpolation interpolation);

struct Method {
    ChosenBeam beam = {};                    // the 4/3 earth
    ChosenInterpolation interpolation = {};  // linear
    ChosenExtent cell = {};                  // a point
    ChosenAveraging averaging = {};          // in dB; in_z is for reflectivity only
    ChosenElevation radial_elevations = {};  // true: the measured elevation of each radial
    // True: values of moments that wrap are averaged on their circle; false: as plain numbers.
    ChosenCircle on_circle = {};

    // Returns a name for provenance: "column-nearest", "column-linear", "eight-point" or
    // "beam-weighted", with "area, " before it if cells are areas.
    [[nodiscard]] std::string name() const;
    bool operator==(const Method&) const = default;
};

}  // namespace stormcellar::grid
