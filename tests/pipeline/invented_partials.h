// tests/pipeline/invented_partials.h -- partials (each is one site's grid on its part of a domain)
// that are made without a volume.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "stormcellar/cache/store.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid_window.h"
#include "tests/pipeline/small_domain.h"

namespace stormcellar::pipeline {

inline UtcTime minute(int minutes) {
    return *parse_utc("2005-08-22T02:00:00Z", UtcTime{}) + std::chrono::minutes{minutes};
}

// A partial of the small domain. The station sees 32 x 32 columns of it, unless set otherwise. The
// volume begins at `minute` and takes four minutes, so its middle is two minutes later.
struct InventedPartial {
    std::string station = "KBGM";
    int minute = 0;
    int column = 0;
    float value = 20;
    int longer_ms = 0;
    bool has_other_codes = false;
    int columns = 32;
    double latitude_deg = 42.2;
};

inline grid::Grid grid_of(const InventedPartial& wanted) {
    grid::Grid made;
    made.spec = grid::window_spec(small_domain().spec, {wanted.column, 0, wanted.columns, 32});
    made.moment = level2::Moment::ref;
    made.time = made.start_time = minute(wanted.minute);
    made.end_time =
        made.time + std::chrono::minutes{4} + std::chrono::milliseconds{wanted.longer_ms};
    made.sites = {{wanted.station, wanted.latitude_deg - wanted.column * 0.01, -75.9, 400}};
    made.provenance.source_files = {level2::volume_name(wanted.station, made.time)};
    made.provenance.stations = {wanted.station};
    made.provenance.method = "column-linear";
    made.provenance.software_version = "test";
    made.values.assign(made.spec.cell_count(), wanted.value);
    made.status.assign(made.spec.cell_count(), grid::CellStatus::no_echo);
    for (std::size_t i = 0; i < made.status.size(); i += 3)
        made.status[i] = grid::CellStatus::value;
    return made;
}

inline std::filesystem::path commit(cache::StoreWriter& store, const std::string& station,
                                    const grid::Grid& grid, bool has_other_codes = false) {
    grid::Quantization codes = grid::default_quantization(grid.moment);
    if (has_other_codes) codes.first_value += 0.5F;
    const auto bricks = grid::BrickGrid::from(grid, codes);
    const auto path = store.commit("north." + station, cache::describe(grid), bricks.view());
    EXPECT_TRUE(path) << path.error().message;
    return path ? *path : std::filesystem::path{};
}

// Commits the partial "north.STATION", and returns its path.
inline std::filesystem::path commit(cache::StoreWriter& store, const InventedPartial& wanted) {
    return commit(store, wanted.station, grid_of(wanted), wanted.has_other_codes);
}

}  // namespace stormcellar::pipeline
