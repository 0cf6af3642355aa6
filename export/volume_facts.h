// export/volume_facts.h -- facts about a volume that several of its formats hold; internal to
// export.
//
// Units     Degrees; times in UTC.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stormcellar/base/station_table.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

// The times of the first and the last radial. If no radial has a plausible time, both are the start
// of the volume.
struct Coverage {
    UtcTime start, end;  // whole seconds, between which the radials are
    bool times_increase = true;
};
[[nodiscard]] Coverage coverage_of(const level2::Volume& volume);
// The same for some sweeps. If no radial has a plausible time, both times are `otherwise`.
[[nodiscard]] Coverage coverage_of(std::span<const level2::Sweep> sweeps, UtcTime otherwise);

// Returns the operator of the radar. Level II does not name it, but the radar's site tells it.
[[nodiscard]] std::string institution_of(const std::optional<Station>& station);

// Returns the fixed angle of the VCP, or else the median of the measured elevations. A few radials
// that were taken while the antenna moved do not shift the median.
[[nodiscard]] float fixed_angle_deg(const level2::Sweep& sweep);

// Returns notes for users as one printable text, one note a line.
[[nodiscard]] std::string text_of_notes(const std::vector<std::string>& notes);

}  // namespace stormcellar::netcdf
