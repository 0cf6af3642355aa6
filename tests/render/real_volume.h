// tests/render/real_volume.h -- a real volume, its site, and its reflectivity on a grid.
#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "tests/testing/data.h"

namespace stormcellar::render {

struct RealVolume {
    std::shared_ptr<level2::Volume> volume;
    grid::SitePosition site;

    [[nodiscard]] grid::Grid on(const grid::GridSpec& spec) const {
        const auto geometry = grid::make_column_geometry(site, spec);
        auto grid = grid::make_grid(*volume, site, **geometry, {});
        EXPECT_TRUE(grid);
        return *std::move(grid);
    }
};

// Decodes a file of the data directory whose name begins with its station.
inline RealVolume real_volume(const std::string& path, const level2::Selection& selection = {}) {
    level2::DecodeOptions options;
    options.fallback_station = path.substr(path.rfind('/') + 1, 4);
    options.selection = selection;
    auto decoded = level2::decode_file(*testing::data_directory() / path, options);
    EXPECT_TRUE(decoded);
    RealVolume real{std::make_shared<level2::Volume>(std::move(decoded->volume)), {}};
    const auto antenna = level2::antenna_position(*real.volume);
    EXPECT_TRUE(antenna);
    real.site = {real.volume->station, antenna->latitude_deg, antenna->longitude_deg,
                 antenna->altitude_m};
    return real;
}

inline grid::Grid real_reflectivity(const std::string& path, double spacing_m, int side) {
    level2::Selection selection;
    selection.moments = {level2::Moment::ref};
    const RealVolume real = real_volume(path, selection);
    grid::GridSpec spec = grid::default_spec(real.site.latitude_deg, real.site.longitude_deg);
    spec.spacing_m = spacing_m;
    spec.nx = spec.ny = side;
    return real.on(spec);
}

}  // namespace stormcellar::render
