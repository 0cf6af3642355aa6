// tests/export/tracked_cells.h -- two storm cells with all kinds of values, for the tests of their
// texts.
#pragma once

#include <vector>

#include "stormcellar/retrieve/storm_cells.h"

namespace stormcellar::cell_export {

inline constexpr UtcTime cells_time{std::chrono::sys_days{std::chrono::year{2013} / 5 / 20} +
                                    std::chrono::hours{20}};

// Returns a cell that was split off and has all values, and a new cell that has only its maximum.
inline std::vector<retrieve::TrackedCell> two_tracked_cells() {
    using namespace std::chrono_literals;
    retrieve::TrackedCell known;
    known.id = "20130520_195500_35.32N_97.51W";
    known.origin = retrieve::CellOrigin::split;
    known.parents = {"20130520_193000_35.20N_97.90W"};
    known.time = cells_time;
    known.cell.position = {35.333333333, -97.5};
    known.cell.area_km2 = 81.26;
    known.cell.max_dbz = 62.5F;
    known.cell.max_dbz_height_m = 4000;
    known.cell.top_m = 15240;  // 50 kft
    known.cell.top_is_at_least = true;
    known.cell.vil_kg_per_m2 = 55;
    known.cell.mesh_mm = 38.1F;
    known.cell.mesh_range = retrieve::MeshRange{33.2F, 43};
    known.cell.azimuthal_shear_per_s = 0.0123F;
    known.past = {{cells_time - 5min, {35.32, -97.51}}};
    known.motion = retrieve::TrackMotion{{10, 5}, 1.5};
    known.forecasts = {{15, cells_time + 15min, {35.4, -97.4}, 4000},
                       {60, cells_time + 60min, {35.6, -97.1}, 15000}};
    retrieve::TrackedCell fresh;
    fresh.id = "20130520_200000_35.00N_98.00W";
    fresh.time = cells_time;
    fresh.cell.position = {35, -98};
    fresh.cell.max_dbz = 45;
    return {known, fresh};
}

}  // namespace stormcellar::cell_export
