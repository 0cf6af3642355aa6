// tests/hard_cases/grid_case.h -- one difficult volume gridded by every method, and what must hold
// for each of them: the same bits for any number of threads, no value that is NaN, and agreement
// with the oracle (grid/judge/oracle.h).
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

// Returns every interpolation with points and areas, reflectivity averaged in dB and in Z.
[[nodiscard]] std::vector<Method> all_methods(level2::Moment moment = level2::Moment::ref);
// Returns for example "area, beam-weighted in Z".
[[nodiscard]] std::string label(const Method& method);

// A plane about the site, in meters; levels in kilometers.
[[nodiscard]] GridSpec plane_about(const SitePosition& site, int side, double spacing_m,
                                   const std::vector<double>& levels_km);

// A site of the plains, and a volume gridded about its site at nine levels from 0.5 to 14 km.
inline const SitePosition plains{"XXXX", 35, -97, 390};
[[nodiscard]] GridCase about(const SitePosition& site, const std::vector<SweepPlan>& plans,
                             int side = 61, double spacing_m = 5000);

// A duct about an antenna at 20 m, from the curvature of the earth below to a layer at 40 to 190 m.
// It holds beams within 0.6 degrees of level, and turns steeper ones, up to 0.8, into the ground.
[[nodiscard]] RefractivityProfile duct_under_a_layer();

// Grids with 1, 2 and 7 threads. Expects the same bits from all, and values between `least` and
// `greatest`.
[[nodiscard]] Grid grid_of(const GridCase& given, const Method& method, double least = -200,
                           double greatest = 1000);

// Compares some hundred columns of a grid with the oracle. Cells whose state or gate depends on
// less than the stated accuracies are left out, as the oracle says. Points must agree. For areas,
// in which a gate on the very edge may count or not, 99 cells in 100 must agree, with values within
// `area_tolerance`.
struct Agreement {
    double area_tolerance = 1;
    double most_doubtful = 0.2;  // of the columns and of the cells
};
void expect_agrees_with_oracle(const GridCase& given, const Method& method, const Grid& grid,
                               const Agreement& agreement = {});

// Does both with every method. `check` may test more.
using Check = std::function<void(const Method& method, const Grid& grid)>;
void expect_sound_by_every_method(const GridCase& given, const Agreement& agreement = {},
                                  const Check& check = {});

// Echo of smooth strength with patches of no echo and of range folding, equal at all elevations.
[[nodiscard]] std::uint16_t patchy_code(double azimuth_deg, double range_m);
// Sweeps of 360 radials and 1 km gates to 150 km with that echo.
[[nodiscard]] SweepPlan patchy_plan(double elevation_deg = 0.5, int cut = 1);

}  // namespace stormcellar::grid
