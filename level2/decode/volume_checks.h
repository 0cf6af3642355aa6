// level2/decode/volume_checks.h -- what a whole volume lacks, and where it contradicts itself.
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

// What a Volume does not say of itself.
struct VolumeFacts {
    bool has_radials = true;  // also when they are of cuts that were not asked for
    bool has_ended = true;    // the last radial was marked as the volume's last
    bool all_cuts = true;     // none was left out because it was not asked for
    // No radial came after the last sweep, not even one that was not asked for.
    bool last_sweep_is_newest = true;
    std::vector<std::size_t> volume_starts = {};  // sweeps at which a further volume begins
    std::optional<RdaStatus> status = {};
};

// Reports a missing position or one that disagrees with the station table, a header's time that
// the radials contradict, radials that are missing or come twice, cuts that are missing, a volume
// without its end, and what the radar itself reports as trouble.
// True when radials or cuts are missing.
[[nodiscard]] bool check_volume(const Volume& volume, const VolumeFacts& facts,
                                ReportWriter report);

// From its first cut to its last radial nothing of this one volume is missing, as far as the
// radials show; bytes that were dropped without a trace in their numbers are in the report only.
[[nodiscard]] bool is_complete(const Volume& volume);
[[nodiscard]] bool is_complete(std::span<const Sweep> sweeps);

// One of the volumes that a file holds.
struct VolumePart {
    std::size_t first_sweep = 0;
    std::size_t sweeps = 0;
    bool complete = false;  // nothing of it is missing, and nothing of the file is damaged
};
// In the order of the file; at least one.
[[nodiscard]] std::vector<VolumePart> volumes_in(const Decoded& decoded);

// Radials of a sweep are numbered from 1; 0, and more than 1000, stand for no number.
struct RadialGaps {
    std::int64_t missing = 0;
    int first_missing = 0;
    std::int64_t repeated = 0;
};
[[nodiscard]] RadialGaps gaps_of(const Sweep& sweep);

}  // namespace stormcellar::level2
