// pipeline/options/domain.h -- a domain: a named region with a grid spec, which the daemon keeps
// gridded.
//
// [[domain]] tables define the domains (daemon/stormcellard.toml explains every key).
//
// Units     Distances are kilometers in the file and meters here.
// Threads   Plain data.
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
    std::vector<std::string> stations;     // empty: every station that reaches the domain
    std::chrono::seconds interval{300};    // between frames, counted from midnight UTC
    std::optional<grid::Overlap> overlap;  // none: the moment's default
    double overlap_length_m = 250'000;
    grid::TimeMethod time = grid::TimeMethod::advected;

    [[nodiscard]] bool takes(std::string_view station) const;
    bool operator==(const Domain&) const = default;
};

// Says when the frames of domains are made.
enum class FramesWhen {
    volume_comes,  // at once when a new volume changes them; the daemon does this
    asked_for,     // by MosaicMaker::make_again(); an archive makes each frame once
};

// West, south, east and north, in degrees. West is greater than east if the bounds cross the
// antimeridian.
using Bounds = std::array<double, 4>;
[[nodiscard]] bool is_bounds(const Bounds& bounds);  // true if in range and not empty
[[nodiscard]] double width_deg(const Bounds& bounds);
[[nodiscard]] grid::GeoPoint middle_of(const Bounds& bounds);
// Returns the largest distances from the spec's center to the boundary of the bounds, along x and
// along y, in columns of the spec. The spec's nx and ny do not matter. Errors: those of
// grid::validate().
[[nodiscard]] Result<grid::ColumnPoint> half_columns_of(const grid::GridSpec& spec,
                                                        const Bounds& bounds);

// Reads heights above mean sea level from the key levels_km: "BOTTOM:TOP:STEP" or a list of
// numbers. Returns none if the key is absent. Complains if the value has neither form, and returns
// none. Complains about an empty list, but returns it.
[[nodiscard]] std::optional<std::vector<double>> read_levels_m(TomlTable& table);
// Returns the moment of this name. If there is none, complains about the key and returns none.
[[nodiscard]] std::optional<level2::Moment> read_moment(TomlTable& table, std::string_view key,
                                                        const std::string& name);
// Reads a list of moments, and drops repeated ones. Returns none if the key is absent. Complains if
// the value is not a list of texts, and returns none. Complains about unknown names, which it
// leaves out, and about an empty list.
[[nodiscard]] std::optional<std::vector<level2::Moment>> read_moments(TomlTable& table,
                                                                      std::string_view key);

// Reads all [[domain]] tables. Complains about invalid domains, but returns them as well, so check
// TomlFile::finish().
[[nodiscard]] std::vector<Domain> read_domains(TomlTable& root);

}  // namespace stormcellar::pipeline
