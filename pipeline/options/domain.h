// pipeline/options/domain.h -- a named region with a grid spec that the daemon keeps gridded.
//
// Read from [[domain]] tables (daemon/stormcellard.toml explains every key). Distances are
// kilometres in the file and metres here.
// Thread contract: plain data.
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
    std::vector<std::string> stations;     // empty: each one that reaches it
    std::chrono::seconds interval{300};    // from frame to frame, counted from midnight UTC
    std::optional<grid::Overlap> overlap;  // none: the moment's default
    double overlap_length_m = 250'000;
    grid::TimeMethod time = grid::TimeMethod::advected;

    [[nodiscard]] bool takes(std::string_view station) const;
    bool operator==(const Domain&) const = default;
};

// When the frames of the domains are made.
enum class FramesWhen {
    volume_comes,  // each that it changes, at once, as the daemon does
    asked_for,     // by MosaicMaker::make_again() alone: of an archive each is then made once
};

// West, south, east, north in degrees; east of the antimeridian west is the greater one.
using Bounds = std::array<double, 4>;
[[nodiscard]] bool is_bounds(const Bounds& bounds);  // in range, and holding something
[[nodiscard]] double width_deg(const Bounds& bounds);
[[nodiscard]] grid::GeoPoint middle_of(const Bounds& bounds);
// How many columns of the spec, whose size does not count, the boundary reaches from its centre at
// most. Errors: those of grid::validate().
[[nodiscard]] Result<grid::ColumnPoint> half_columns_of(const grid::GridSpec& spec,
                                                        const Bounds& bounds);

// Heights above mean sea level of the key levels_km: "BOTTOM:TOP:STEP" or a list; none when the key
// is absent or, with a complaint noted, makes no sense.
[[nodiscard]] std::optional<std::vector<double>> read_levels_m(TomlTable& table);
// One moment's name; none with a complaint noted.
[[nodiscard]] std::optional<level2::Moment> read_moment(TomlTable& table, std::string_view key,
                                                        const std::string& name);

// All [[domain]] tables; what makes no sense is complained of and left out.
[[nodiscard]] std::vector<Domain> read_domains(TomlTable& root);

}  // namespace stormcellar::pipeline
