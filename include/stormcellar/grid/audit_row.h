// stormcellar/grid/audit_row.h -- what an audit found of one sweep and range, small enough for
// every file.
//
// grid/judge/audit.h makes the rows; here is what may be asked of them. Values are in the moment's
// unit: dB of REF and ZDR, m/s of VEL. A row is 32 bytes, as docs/cache-format.md has it. Threads:
// plain values.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

struct AuditRow {
    float elevation_deg = 0;        // the sweep's, as it was measured
    float range_from_m = 0;         // gates from this slant range on,
    float range_to_m = 0;           // below this one; infinite of the last class
    std::uint32_t sampled = 0;      // gates that lie within the grid
    std::uint32_t same_status = 0;  // of these: the grid has the gate's status there
    std::uint32_t count = 0;        // of these: gate and grid have a value
    float rms = 0;                  // of grid minus gate over `count`; 0 of none
    float mean = 0;

    bool operator==(const AuditRow&) const = default;
};
static_assert(sizeof(AuditRow) == 32);

// Whether an audit can have given this row: finite numbers (but for range_to_m), counts that
// include each other, a mean that is no larger than the RMS.
[[nodiscard]] bool is_possible(const AuditRow& row);

// All rows as one: of the lowest elevation and the whole range. Of none: a row of zeros.
[[nodiscard]] AuditRow pooled(std::span<const AuditRow> rows);
// A row a range class, rising, over all sweeps; a row a sweep, in their order, over all ranges.
[[nodiscard]] std::vector<AuditRow> pooled_by_range(std::span<const AuditRow> rows);
[[nodiscard]] std::vector<AuditRow> pooled_by_sweep(std::span<const AuditRow> rows);

// Of differences: that of the moment, but dB of REF.
[[nodiscard]] std::string_view difference_unit(level2::Moment moment);
// "0 to 60 km", "beyond 240 km".
[[nodiscard]] std::string range_text(const AuditRow& row);
// "RMS 1.23 dB, mean -0.04 dB over 12345 gates; status the same in 97.1 % of 40000"; of a moment
// whose unit is empty or 1 the numbers alone.
[[nodiscard]] std::string errors_text(const AuditRow& row, std::string_view unit);

}  // namespace stormcellar::grid
