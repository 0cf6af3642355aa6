// grid/plan/grid_effects.h -- defines, for the accuracy planner, the steps of gridding, the ways to
// do each step (rungs), and the effects that better rungs include.
//
//   step           rungs, from cheap to exact                      effects that reach them
//   frame          sphere, table, geodesic                         ellipsoid, exact_geodesic
//   beam           flat earth, 4/3 earth, traced                   earth_curvature, refraction
//   elevation      one for each sweep, one for each radial         antenna_jitter
//   interpolation  nearest, linear, eight-point, beam-weighted     column_interpolation,
//                                                       horizontal_interpolation, beam_width
//   cell           point, area                                     cell_size
//   averaging      in dB or, for REF, in Z                         none: the user chooses
//   circle         as numbers, on the circle (VEL, PHI only)      velocity_folding, phase_folding
// The exact form of the chain is the last rung of every step. A budget bounds the difference from
// the exact form on the same gates. docs/accuracy.md says which forms are nearer to the truth.
//
// Threads   Pure functions, except the functions that take a scene (grid/plan/grid_scene.h).
#pragma once

#include <span>
#include <string_view>

#include "grid/plan/grid_scene.h"
#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/accuracy/plan.h"

namespace stormcellar::grid {

// The names of the steps. They are constants, so that a misspelled name does not compile.
namespace step {
inline constexpr std::string_view frame = "frame";
inline constexpr std::string_view beam = "beam";
inline constexpr std::string_view elevation = "elevation";
inline constexpr std::string_view interpolation = "interpolation";
inline constexpr std::string_view cell = "cell";
inline constexpr std::string_view averaging = "averaging";
inline constexpr std::string_view circle = "circle";
}  // namespace step

// Returns the chain with its names, rungs and sentences. All sizes and costs are 0, and all
// settings are automatic. All forms of the chain, including the exact form, use `averaging`,
// because neither dB nor Z approximates the other.
[[nodiscard]] accuracy::Chain effects_of(level2::Moment moment,
                                         Averaging averaging = Averaging::in_db);

[[nodiscard]] SceneChoice scene_choice(const accuracy::Chain& chain,
                                       const accuracy::Choice& choice);

// Returns the usual choice, changed by the settings of the effects. The usual choice is the table,
// the 4/3 earth, each radial's elevation, and linear interpolation along the column at a point, in
// the unit of the moment and on its circle.
[[nodiscard]] accuracy::Choice usual_choice(const accuracy::Chain& chain);

// Returns the choice with which other choices are compared: the last rung of every step, but with
// the table as the frame. Geodesics for each column would differ from the table by a millimeter and
// take half a second.
[[nodiscard]] accuracy::Choice reference_choice(const accuracy::Chain& chain);

// Returns the choice that is measured in place of `choice`. If its frame is geodesics, the table
// replaces them; all else is equal.
[[nodiscard]] SceneChoice as_measured(SceneChoice choice);

// Returns the extra effort (stormcellar/accuracy/effect.h) of these two rungs together, which adds
// to the sum of their efforts.
[[nodiscard]] double joint_effort(Interpolation interpolation, CellExtent cell);

// default_choice() returns the choice that is used without a budget. This is usual_choice(), except
// that cells are areas if they are wider than the beam at 160 km (2.7 km for a WSR-88D), because
// samples at points would alias. The choice does not depend on the extent of the grid, so that
// cells stay the same if the grid covers a larger area.
inline constexpr double wide_cells_arc_m = 160e3;
[[nodiscard]] accuracy::Choice default_choice(const accuracy::Chain& chain, const GridSpec& spec,
                                              double beam_width_deg);

// Returns the unit: dB for REF, ZDR and CFP, m/s for VEL and SW, degrees for PHI, a ratio for RHO.
[[nodiscard]] accuracy::ValueUnit value_unit_of(level2::Moment moment);

struct PlanOptions {
    std::size_t predict_columns = 500;  // for predicting the size and cost of each effect
    // For bounds on the chosen form. More columns are drawn if a bound needs them.
    std::size_t measure_columns = 2500;
    std::uint64_t seed = 1;
};

// Predicts the size and cost of each effect for this scene. Positions have proven bounds; values
// come from a sample.
[[nodiscard]] Status predict(GridScene& scene, const PlanOptions& options, accuracy::Chain& chain);

struct GridPlan {
    accuracy::Plan plan;
    SceneChoice choice;
};

// Predicts, chooses and measures (accuracy/governor.h). Without a budget, returns the plan of the
// default choice, with the size of each effect. Errors: those of accuracy::govern() and of
// gridding.
[[nodiscard]] Result<GridPlan> plan_grid(GridScene& scene, accuracy::Chain chain,
                                         const std::optional<accuracy::Budget>& budget,
                                         const PlanOptions& options = {});

// Returns the error that the plan predicts, as text for the provenance: "position 70.3 m, value
// 0.42 dB (99th percentile)".
[[nodiscard]] std::string predicted_error(const accuracy::Plan& plan);

}  // namespace stormcellar::grid
