// stormcellar/grid/grid.h -- gridded values with their four-state status, dense in memory.
//
// Units     Values are in the unit of the moment; positions are in degrees and meters on WGS84,
//           with heights above mean sea level.
// Threads   Plain data; any thread may read it while no thread writes it.
// Errors    None.
#pragma once

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

// The four states of a cell (docs/geometry.md). They are kept apart from the gate to the pixel.
enum class CellStatus : std::uint8_t {
    not_seen = 0,      // blind region, beyond range, missing radials or sweeps
    no_echo = 1,       // seen, below threshold
    range_folded = 2,  // echo from beyond the unambiguous range
    value = 3,
};
[[nodiscard]] std::string_view cell_status_name(CellStatus status);

// Time of one sweep, and speed of the antenna (grid/sweep/sweep_clock.h).
struct SweepTime {
    double elevation_deg = 0;
    UtcTime start;                 // time of the first radial
    double first_azimuth_deg = 0;  // azimuth of that radial
    double degrees_per_s = 0;      // clockwise; 0: not known, the whole sweep has the time `start`
    bool operator==(const SweepTime&) const = default;
};

// The volume of one site, as one part of a frame made from several volumes
// (pipeline/mosaic/frame_parts.h).
struct FramePart {
    std::string icao;
    UtcTime time;                   // start of the volume, which names it in time
    std::uint64_t fingerprint = 0;  // identifies its cells, its place and its times
    GridWindow window;              // the columns of the frame on which it lies
    bool operator==(const FramePart&) const = default;
};

// The origin of a grid, and how it was made. Every file and every loop holds it.
struct Provenance {
    // Names of the volumes by level2::volume_name(), so that a grid has the same bytes wherever it
    // was made. Grids that never reach a cache have names of files instead, without directories.
    std::vector<std::string> source_files;
    std::vector<std::string> stations;  // ICAOs
    std::string method;                 // e.g. "column-linear"
    std::string beam_model;             // e.g. "4/3 earth"
    std::string averaging;              // "dBZ" or "Z"
    std::string effects;  // rungs chosen by a plan, as in "frame: sphere, beam: ..."; or empty
    std::string predicted_error;  // as predicted by that plan; or empty
    std::string software_version;
    int vcp = 0;                     // 0: unknown
    bool partial = false;            // the volume was not complete
    std::vector<std::string> notes;  // e.g. that a position disagrees with the table
    // The faults that the radars report about themselves: "KTLX: standby, maintenance required".
    std::vector<std::string> radar_troubles;
    // For a mosaic: the machines whose partials came too late and are missing, and since when:
    // "north (KFWS KTLX): nothing since 2013-05-20T20:04:00Z".
    std::vector<std::string> left_out;
    // For a frame between volumes: whether a later volume will change it, and the number of volumes
    // that it is made from. The revision is 0 if the grid is not a frame.
    bool provisional = false;
    int revision = 0;
    std::vector<FramePart> parts;  // of a frame, by ICAO, then time; empty: not known, or no frame
    // of a frame: identifies the rules that merged the parts; 0: not known
    std::uint64_t recipe = 0;
    // the sweeps used, rising; empty for several sites or without times
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
    UtcTime time;        // start of the volume, which names the grid in time
    UtcTime start_time;  // time of the first radial used
    UtcTime end_time;    // time of the last radial used
    // The instant for which the grid was made, if that is not the start of the volume.
    std::optional<UtcTime> frame_time;
    std::vector<SitePosition> sites;
    Provenance provenance;
    // index by spec.index(); 0, without meaning, where there is no value
    std::vector<float> values;
    std::vector<CellStatus> status;  // same shape
    CellDetails details;             // same shape if they were asked for, else empty
    // For a mosaic (stormcellar/grid/mosaic.h): how many sites see a cell, and the sum of their
    // weights; 0 where no site sees it. Both have the same shape if they were asked for, else they
    // are empty.
    std::vector<std::uint16_t> site_counts;
    std::vector<float> site_weights;
};

}  // namespace stormcellar::grid
