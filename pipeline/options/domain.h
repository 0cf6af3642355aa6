// pipeline/options/domain.h -- a named region with a grid spec that the daemon keeps gridded.
//
// Domains are read from [[domain]] tables (daemon/stormcellard.toml explains every key).
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
    std::vector<std::string> stations;     // empty: each station that reaches it
    std::chrono::seconds interval{300};    // from frame to frame, counted from midnight UTC
    std::optional<grid::Overlap> overlap;  // none: the moment's default
    double overlap_length_m = 250'000;
    grid::TimeMethod time = grid::TimeMethod::advected;

    [[nodiscard]] bool takes(std::string_view station) const;
    bool operator==(const Domain&) const = default;
};

// Tells when frames of the domains are made.
enum class FramesWhen {
    volume_comes,  // at once when a volume changes them, as the daemon does
    asked_for,     // only by MosaicMaker::make_again(), so that an archive makes each frame once
};

// West, south, east and north in degrees. Across the antimeridian, west is greater than east.
using Bounds = std::array<double, 4>;
[[nodiscard]] bool is_bounds(const Bounds& bounds);  // true if in range and not empty
[[nodiscard]] double width_deg(const Bounds& bounds);
[[nodiscard]] grid::GeoPoint middle_of(const Bounds& bounds);
// Returns the largest distances, along x and y in columns of the spec, from the spec's center to
// the boundary of the bounds. The spec's nx and ny do not matter. Errors: those of
// grid::validate().
[[nodiscard]] Result<grid::ColumnPoint> half_columns_of(const grid::GridSpec& spec,
                                                        const Bounds& bounds);

// Reads heights above mean sea level from the key levels_km: "BOTTOM:TOP:STEP" or a list of
// numbers. Returns none if the key is absent or, with a complaint, if its value has another form.
// Complains about an empty list, but returns it.
[[nodiscard]] std::optional<std::vector<double>> read_levels_m(TomlTable& table);
// Returns the moment of this name, or none, with a complaint about the key.
[[nodiscard]] std::optional<level2::Moment> read_moment(TomlTable& table, std::string_view key,
                                                        const std::string& name);
// Reads a list of moments and drops repeated ones. Returns none if the key is absent or, with a
// complaint, if its value is not a list of texts. Complains about unknown names, which are left
// out, and about an empty list.
[[nodiscard]] std::optional<std::vector<level2::Moment>> read_moments(TomlTable& table,
                                                                      std::string_view key);

// Reads all [[domain]] tables. Complains about invalid domains, but returns them, too, so check
// TomlFile::finish().
[[nodiscard]] std::vector<Domain> read_domains(TomlTable& root);

}  // namespace stormcellar::pipeline
