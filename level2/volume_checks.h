// level2/volume_checks.h -- what a whole volume lacks, and where it contradicts itself.
#pragma once

#include <optional>

#include "level2/message_2.h"
#include "level2/report_writer.h"
#include "level2/volume.h"

namespace stormcellar::level2 {

// Reports a missing position or one that disagrees with the station table, a header's time that
// the radials contradict, radials that are missing or come twice, a volume without its end, and
// what the radar itself reports as trouble.
// True when radials are missing.
[[nodiscard]] bool check_volume(const Volume& volume, bool has_radials, bool has_ended,
                                const std::optional<RdaStatus>& status, ReportWriter report);

// Radials of a sweep are numbered from 1; 0 stands for no number.
struct RadialGaps {
    int missing = 0;
    int first_missing = 0;
    int repeated = 0;
};
[[nodiscard]] RadialGaps gaps_of(const Sweep& sweep);

}  // namespace stormcellar::level2
