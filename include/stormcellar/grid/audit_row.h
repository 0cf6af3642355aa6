// stormcellar/grid/audit_row.h -- the result of an audit, which compares a grid with its gates, for
// one sweep and one class of ranges.
//
// grid/judge/audit.h makes the rows. Every grid file holds rows, so each takes only 32 bytes
// (docs/cache-format.md).
//
// Units     Values are in the unit of the moment (dB for REF and ZDR, m/s for VEL); ranges are
//           slant ranges in meters.
// Threads   Plain values and pure functions.
// Errors    None; is_possible() checks rows from a file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

struct AuditRow {
    float elevation_deg = 0;        // the measured elevation of the sweep
    float range_from_m = 0;         // least slant range of the class
    float range_to_m = 0;           // end of the class (not included); infinite for the last class
    std::uint32_t sampled = 0;      // gates within the grid
    std::uint32_t same_status = 0;  // of these, gates whose cell has the same status
    std::uint32_t count = 0;        // of these, gates with a value whose cell also has a value
    float rms = 0;                  // of cell minus gate, over `count`; 0 if `count` is 0
    float mean = 0;

    bool operator==(const AuditRow&) const = default;
};
static_assert(sizeof(AuditRow) == 32);

// Returns true if an audit can have made this row: its numbers are finite (only range_to_m may be
// infinite), `count` <= `same_status` <= `sampled`, and the mean is no larger than the RMS.
[[nodiscard]] bool is_possible(const AuditRow& row);

// Pools all rows into one, with the lowest elevation and the whole range. Without rows, returns a
// row of zeros.
[[nodiscard]] AuditRow pooled(std::span<const AuditRow> rows);
// pooled_by_range() makes one row for each class of ranges, by rising range. pooled_by_sweep()
// makes one row for each elevation, by rising elevation.
[[nodiscard]] std::vector<AuditRow> pooled_by_range(std::span<const AuditRow> rows);
[[nodiscard]] std::vector<AuditRow> pooled_by_sweep(std::span<const AuditRow> rows);

// Returns the unit of differences: the unit of the moment, but dB for REF.
[[nodiscard]] std::string_view difference_unit(level2::Moment moment);
// Returns a class of ranges as text: "0 to 60 km", "beyond 240 km".
[[nodiscard]] std::string range_text(const AuditRow& row);
// Returns the errors as text: "RMS 1.23 dB, mean -0.04 dB over 12345 gates; status the same in 97.1
// % of 40000". Omits a unit that is empty or "1". Without values or gates, the text says so.
[[nodiscard]] std::string errors_text(const AuditRow& row, std::string_view unit);

}  // namespace stormcellar::grid
