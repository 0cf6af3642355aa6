// stormcellar/grid/grid.h -- gridded values with their four-state status, dense in memory.
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

// The four states of a cell (DESIGN section 5). They stay apart from the gate to the pixel.
enum class CellStatus : std::uint8_t {
    not_seen = 0,      // blind region, beyond range, missing radials or sweeps
    no_echo = 1,       // seen, below threshold
    range_folded = 2,  // echo from beyond the unambiguous range
    value = 3,
};
[[nodiscard]] std::string_view cell_status_name(CellStatus status);

// When and how fast the antenna turned for one sweep (grid/sweep/sweep_clock.h).
struct SweepTime {
    double elevation_deg = 0;
    UtcTime start;                 // of its first radial
    double first_azimuth_deg = 0;  // of that radial
    double degrees_per_s = 0;      // clockwise; 0: not known, all is of `start`
    bool operator==(const SweepTime&) const = default;
};

// One site's volume, as a part of a frame that several make (pipeline/mosaic/frame_parts.h).
struct FramePart {
    std::string icao;
    UtcTime time;                   // start of the volume: the part's name in time
    std::uint64_t fingerprint = 0;  // of its cells, its place and its times
    GridWindow window;              // the columns of the frame on which it lies
    bool operator==(const FramePart&) const = default;
};

// Where a grid comes from and how it was made; written into every file and loop.
struct Provenance {
    std::vector<std::string> source_files;  // names without directories
    std::vector<std::string> stations;      // ICAOs
    std::string method;                     // e.g. "column-linear"
    std::string beam_model;                 // e.g. "4/3 earth"
    std::string averaging;                  // "dBZ" or "Z"
    std::string effects;  // rungs chosen by a plan, as in "frame: sphere, beam: ..."; or empty
    std::string predicted_error;  // by that plan; or empty
    std::string software_version;
    int vcp = 0;           // 0: unknown
    bool partial = false;  // the volume was not complete
    // Of the newest source file, since the epoch: tells a re-sent volume from an older file of it.
    std::int64_t source_modified_ns = 0;  // 0: unknown
    std::vector<std::string> notes;       // e.g. a position that disagrees with the table
    // What the radars reported to be wrong with them, "KTLX: standby, maintenance required".
    std::vector<std::string> radar_troubles;
    // Of a frame between volumes: a later volume will change it; how often it was made. 0: no
    // frame.
    bool provisional = false;
    int revision = 0;
    std::vector<FramePart> parts;   // of a frame: by ICAO, then time; empty: not known, or no frame
    std::uint64_t recipe = 0;       // of a frame: by which rules the parts became one; 0: not known
    std::vector<SweepTime> sweeps;  // that it is made of, rising; none: of several sites or undated
    std::vector<AuditRow> audit;    // against the gates (grid/judge/audit.h); empty: not audited
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
    UtcTime time;        // start of the volume: the grid's name in time
    UtcTime start_time;  // of the first radial used
    UtcTime end_time;    // of the last radial used
    // The instant that the grid was asked for, where that is not the start of the volume.
    std::optional<UtcTime> frame_time;
    std::vector<SitePosition> sites;
    Provenance provenance;
    std::vector<float> values;       // index by spec.index(); unspecified (0) where not a value
    std::vector<CellStatus> status;  // same shape
    CellDetails details;             // of the same shape, where they were asked for
    // Of a mosaic, of the same shape where they were asked for, else empty
    // (stormcellar/grid/mosaic.h): how many sites see a cell, and the sum of their weights. 0 where
    // none does.
    std::vector<std::uint16_t> site_counts;
    std::vector<float> site_weights;
};

}  // namespace stormcellar::grid
