// stormcellar/grid/grid.h -- gridded values with their status, dense in memory.
//
// Units     Values are in the unit of the moment; positions are in degrees and meters on WGS84,
//           with heights above mean sea level.
// Threads   Plain data; any thread may read it while no thread writes it.
// Errors    None.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/audit_row.h"
#include "stormcellar/grid/cell_details.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

// The states of a cell (docs/geometry.md). Every step from gate to pixel keeps them apart. Files
// and interfaces have these numbers.
enum class CellStatus : std::uint8_t {
    not_seen = 0,      // blind region, beyond range, missing radials or sweeps
    no_echo = 1,       // seen, below threshold
    range_folded = 2,  // echo from beyond the unambiguous range
    value = 3,
    // 4 means "unavailable" in Zarr stores
    ambiguous = 5,  // only in derived moments: echo whose value cannot be derived
};
inline constexpr std::size_t cell_status_count = 6;  // of an array with the states as indices
[[nodiscard]] std::string_view cell_status_name(CellStatus status);
// Returns the states that a cell of a grid of the moment can have, with rising numbers.
[[nodiscard]] std::vector<CellStatus> states_of(level2::Moment moment);

// Time of one sweep, and speed of the antenna (grid/sweep/sweep_clock.h).
struct SweepTime {
    double elevation_deg = 0;
    UtcTime start;                 // time of the first radial
    double first_azimuth_deg = 0;  // azimuth of the first radial
    double degrees_per_s = 0;      // clockwise; 0: unknown, so all radials count as of `start`
    bool operator==(const SweepTime&) const = default;
};

// The volume of one site, as a part of a frame: a grid for an instant, merged from several volumes
// (pipeline/mosaic/frame_parts.h).
struct FramePart {
    std::string icao;
    UtcTime time;                   // start of the volume, which identifies it
    std::uint64_t fingerprint = 0;  // identifies the part's cells, position and times
    GridWindow window;              // the columns of the frame that the part covers
    bool operator==(const FramePart&) const = default;
};

// The origin of a grid, and how it was made. Every grid file and every loop file holds a
// Provenance.
struct Provenance {
    // Names of the volumes by level2::volume_name(), so that a grid has the same bytes on every
    // machine. Grids that never reach a cache have the names of the volumes' files instead, without
    // directories.
    std::vector<std::string> source_files;
    std::vector<std::string> stations;  // ICAOs
    std::string method;                 // e.g. "column-linear"
    std::string beam_model;             // e.g. "4/3 earth"
    std::string averaging;              // "Z", or the moment's unit, such as "dBZ"
    std::string effects;          // a plan's rungs, as in "frame: sphere, beam: ..."; or empty
    std::string predicted_error;  // the plan's prediction; or empty
    std::string software_version;
    int vcp = 0;                     // 0: unknown
    bool partial = false;            // the volume was not complete
    std::vector<std::string> notes;  // e.g. that a position disagrees with the table
    // Faults that the radars report about themselves, as in "KTLX: standby, maintenance required".
    std::vector<std::string> radar_troubles;
    // For a mosaic: machines whose partials came too late and are missing, with the time of their
    // last partial, as in "north (KFWS KTLX): nothing since 2013-05-20T20:04:00Z".
    std::vector<std::string> left_out;
    // For a frame (see FramePart): `provisional` is true if a later volume will change the frame.
    // `revision` is the number of volumes from which the frame is made, or 0 if the grid is not a
    // frame.
    bool provisional = false;
    int revision = 0;
    std::vector<FramePart> parts;  // of a frame, by ICAO, then time; empty: unknown, or not a frame
    // of a frame: identifies the rules that merged the parts; 0: unknown
    std::uint64_t recipe = 0;
    // the sweeps used, by rising elevation; empty for several sites or without times
    std::vector<SweepTime> sweeps;
    std::vector<AuditRow> audit;  // result of grid/judge/audit.h; empty: not audited
};

struct SitePosition {
    std::string icao;
    double latitude_deg = 0;
    double longitude_deg = 0;
    double altitude_m = 0;
};

struct Grid {
    GridSpec spec;
    level2::Moment moment = level2::Moment::ref;
    UtcTime time;        // start of the volume, which identifies the grid
    UtcTime start_time;  // time of the first radial used
    UtcTime end_time;    // time of the last radial used
    // The instant for which the grid was made, if it differs from the start of the volume.
    std::optional<UtcTime> frame_time;
    std::vector<SitePosition> sites;
    Provenance provenance;
    // indexed by spec.index(); a meaningless 0 where the status is not `value`
    std::vector<float> values;
    std::vector<CellStatus> status;  // same shape
    CellDetails details;             // same shape if the caller asked for details, else empty
    // For a mosaic (stormcellar/grid/mosaic.h): the number of sites that see a cell, and the sum of
    // their weights; 0 where no site sees the cell. Each has the same shape if the caller asked for
    // it, else it is empty.
    std::vector<std::uint16_t> site_counts;
    std::vector<float> site_weights;
};

}  // namespace stormcellar::grid
