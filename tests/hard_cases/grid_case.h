// tests/hard_cases/grid_case.h -- grids a difficult volume by every method. For each method, the
// grid must have the same bits for any number of threads, must have no NaN, and must agree with the
// oracle (grid/judge/oracle.h).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/grid/gridder.h"
#include "tests/grid/method_of.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {

struct GridCase {
    level2::Volume volume;
    SitePosition site{"XXXX", 35, -97, 390};
    GridSpec spec;
    level2::Moment moment = level2::Moment::ref;
    double beam_width_deg = 0.95;
    std::optional<RefractivityProfile> profile;
};

// Returns the methods: every interpolation with points and with areas, for reflectivity averaged
// both in dB and in Z.
[[nodiscard]] std::vector<Method> all_methods(level2::Moment moment = level2::Moment::ref);
// Returns a name of the method, such as "area, beam-weighted in Z".
[[nodiscard]] std::string label(const Method& method);

// Returns a square grid centered on the site, with `side` cells on a side.
[[nodiscard]] GridSpec plane_about(const SitePosition& site, int side, double spacing_m,
                                   const std::vector<double>& levels_km);

// `plains` is a site on flat land. about() returns a volume of these sweeps, with a grid centered
// on the site at nine levels from 0.5 to 14 km.
inline const SitePosition plains{"XXXX", 35, -97, 390};
[[nodiscard]] GridCase about(const SitePosition& site, const std::vector<SweepPlan>& plans,
                             int side = 61, double spacing_m = 5000);

// Returns a profile with a duct under a layer at 40 to 190 m, for an antenna at 20 m. The duct
// traps beams within 0.6 degrees of the horizontal, and bends steeper beams, up to 0.8 degrees,
// into the ground.
[[nodiscard]] RefractivityProfile duct_under_a_layer();

// Grids the volume with 1, 2 and 7 threads. Expects the same bits each time, and values between
// `least` and `greatest`.
[[nodiscard]] Grid grid_of(const GridCase& given, const Method& method, double least = -200,
                           double greatest = 1000);

// The allowed differences from the oracle. Some 40 columns of a grid are compared, or some 10 for a
// method with areas. Doubtful cells, whose state or gate depends on less than the stated
// accuracies, are left out. With points, all cells must agree. With areas, a gate on the very edge
// may count or not, so 99 cells in 100 must agree, with values within `area_tolerance`.
struct Agreement {
    double area_tolerance = 1;
    double most_doubtful = 0.2;  // largest share of doubtful columns and cells
};
void expect_agrees_with_oracle(const GridCase& given, const Method& method, const Grid& grid,
                               const Agreement& agreement = {});

// Calls grid_of() and expect_agrees_with_oracle() with every method, and then `check`, if given.
using Check = std::function<void(const Method& method, const Grid& grid)>;
void expect_sound_by_every_method(const GridCase& given, const Agreement& agreement = {},
                                  const Check& check = {});

// Returns the code of smooth echo with patches of no echo and of range folding. The code does not
// depend on the elevation.
[[nodiscard]] std::uint16_t patchy_code(double azimuth_deg, double range_m);
// Returns a sweep of 360 radials and 1 km gates to 150 km with patchy_code().
[[nodiscard]] SweepPlan patchy_plan(double elevation_deg = 0.5, int cut = 1);

}  // namespace stormcellar::grid
