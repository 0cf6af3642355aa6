// pipeline/options/domain.h -- a named region with a grid spec that the daemon keeps gridded.
//
// It is read from a [[domain]] table (daemon/stormcellard.toml explains every key). Distances are
// kilometers in the file and meters here. Thread contract: plain data, and functions without state.
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/toml_file.h"
#include "grid/mosaic/time_interpolation.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/grid/mosaic.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

struct Domain {
    std::string name;
    grid::GridSpec spec;
    std::vector<level2::Moment> moments = {level2::Moment::ref};
    std::vector<std::string> stations;     // empty: every station that reaches it
    std::chrono::seconds interval{300};    // from frame to frame, counted from midnight UTC
    std::optional<grid::Overlap> overlap;  // none: the moment's default
    double overlap_length_m = 250'000;
    grid::TimeMethod time = grid::TimeMethod::advected;

    [[nodiscard]] bool takes(std::string_view station) const;
    bool operator==(const Domain&) const = default;
};

// West, south, east, north in degrees; if the box spans the antimeridian, west is the greater one.
using Bounds = std::array<double, 4>;
[[nodiscard]] bool is_bounds(const Bounds& bounds);  // in range, and not empty
[[nodiscard]] double width_deg(const Bounds& bounds);
[[nodiscard]] grid::GeoPoint middle_of(const Bounds& bounds);
// How many columns of the spec (whose size does not count) the boundary reaches from its center at
// most. Errors: those of grid::validate().
[[nodiscard]] Result<grid::ColumnPoint> half_columns_of(const grid::GridSpec& spec,
                                                        const Bounds& bounds);

// The heights above mean sea level of the key levels_km: "BOTTOM:TOP:STEP" or a list. None if the
// key is absent, or invalid; then a complaint is noted.
[[nodiscard]] std::optional<std::vector<double>> read_levels_m(TomlTable& table);
// The moment of this name; none if there is none, and then a complaint is noted.
[[nodiscard]] std::optional<level2::Moment> read_moment(TomlTable& table, std::string_view key,
                                                        const std::string& name);

// Reads all [[domain]] tables; complains of invalid ones and leaves them out.
[[nodiscard]] std::vector<Domain> read_domains(TomlTable& root);

}  // namespace stormcellar::pipeline
