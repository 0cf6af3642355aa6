// level2/decode/volume_checks.h -- reports the missing parts of a volume and the contradictions in
// it.
//
// Threads   Pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "level2/decode/report_writer.h"
#include "level2/messages/message_2.h"
#include "stormcellar/level2/decoded.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Facts that a Volume does not hold itself.
struct VolumeFacts {
    bool has_radials = true;  // true also if all radials belong to cuts that are not selected
    bool has_ended = true;    // the last radial was marked as the last of the volume
    bool all_cuts = true;     // no cut was left out because it is not selected
    // True if no radial came after the last sweep, not even one that is not selected.
    bool last_sweep_is_newest = true;
    std::vector<std::size_t> volume_starts = {};  // sweeps at which a further volume begins
    std::optional<RdaStatus> status = {};
};

// Reports what is wrong in a volume: a position that is missing or disagrees with the station
// table, times that contradict each other, radials that are missing or repeated, missing cuts, a
// volume without its end, and the faults that the radar reports about itself. Returns true if
// radials or cuts are missing, or if a volume stops before its end and another volume follows. If
// facts.all_cuts is false, only missing radials count.
[[nodiscard]] bool check_volume(const Volume& volume, const VolumeFacts& facts,
                                ReportWriter report);

// Returns true if the volume has its end, and its radials and cuts are numbered without a gap. The
// argument must be one volume. Dropped bytes that leave no gap in the numbers do not count.
[[nodiscard]] bool is_complete(const Volume& volume);
[[nodiscard]] bool is_complete(std::span<const Sweep> sweeps);

// Returns true if a sweep of the volume has the moment.
[[nodiscard]] bool holds(const Volume& volume, Moment moment);

// One of the volumes in a file.
struct VolumePart {
    std::size_t first_sweep = 0;
    std::size_t sweeps = 0;
    bool complete = false;  // is_complete(), and the report is not `damaged`
};
// Returns the volumes in the order of the file, at least one.
[[nodiscard]] std::vector<VolumePart> volumes_in(const Decoded& decoded);

// Gaps in the azimuth numbers of a sweep, which begin at 1. The number 0, and numbers above 1000,
// do not count.
struct RadialGaps {
    std::int64_t missing = 0;
    int first_missing = 0;
    std::int64_t repeated = 0;
};
[[nodiscard]] RadialGaps gaps_of(const Sweep& sweep);

}  // namespace stormcellar::level2
