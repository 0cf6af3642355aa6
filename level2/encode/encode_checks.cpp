#include "level2/encode/encode_checks.h"

#include <algorithm>

#include "level2/decode/fragment_builder.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::level2 {
namespace {

// Checks that the rows exist and have the stated lengths.
Status check_rows(const Sweep& sweep, std::size_t index, const SweepMoment& moment) {
    const auto name = moment_name(moment.moment);
    const bool narrow = moment.word_size_bits == 8;
    if (!narrow && (moment.word_size_bits != 16 || sweep.message_type == 1)) {
        return refuse("{} of sweep {} has codes of {} bits in message {}", name, index,
                      moment.word_size_bits, sweep.message_type);
    }
    if (moment.gate_stride < 0 || moment.gate_counts.size() != sweep.radials.size()) {
        return refuse("{} of sweep {} has {} rows for {} radials", name, index,
                      moment.gate_counts.size(), sweep.radials.size());
    }
    const std::size_t codes = narrow ? moment.codes8.size() : moment.codes16.size();
    const auto stride = static_cast<std::size_t>(moment.gate_stride);
    if (codes != stride * sweep.radials.size()) {
        return refuse("{} of sweep {} has {} codes for {} rows of {}", name, index, codes,
                      sweep.radials.size(), stride);
    }
    const auto too_long = [stride](std::uint16_t gates) { return gates > stride; };
    if (std::any_of(moment.gate_counts.begin(), moment.gate_counts.end(), too_long)) {
        return refuse("{} of sweep {} counts more gates than a row holds", name, index);
    }
    return {};
}

// Checks that the decoder would begin and end sweeps at the same radials. Only the status, the
// elevation number and the message type separate radials into sweeps.
Status check_limits(const Volume& volume, std::size_t index) {
    const Sweep& sweep = volume.sweeps[index];
    if (sweep.radials.empty()) return refuse("sweep {} has no radials", index);
    for (std::size_t i = 1; i < sweep.radials.size(); ++i) {
        if (begins_sweep(sweep.radials[i])) {
            return refuse("radial {} of sweep {} has status {}, which begins a sweep", i, index,
                          sweep.radials[i].status);
        }
    }
    if (index == 0 || begins_sweep(sweep.radials.front())) return {};
    const Sweep& previous = volume.sweeps[index - 1];
    if (sweep.elevation_number == previous.elevation_number &&
        sweep.message_type == previous.message_type) {
        return refuse(
            "sweep {} has the same elevation number, {}, as the sweep before it, and the status of "
            "its first radial does not begin a sweep",
            index, sweep.elevation_number);
    }
    return {};
}

Status check_sweep(const Volume& volume, std::size_t index) {
    const Sweep& sweep = volume.sweeps[index];
    if (sweep.message_type != 1 && sweep.message_type != 31) {
        return refuse("sweep {} came in message {}, not 1 or 31", index, sweep.message_type);
    }
    if (Status limits = check_limits(volume, index); !limits) return limits;
    for (const SweepMoment& moment : sweep.moments) {
        if (Status rows = check_rows(sweep, index, moment); !rows) return rows;
    }
    return {};
}

}  // namespace

Status check_encodable(const Volume& volume) {
    if (volume.sweeps.empty() && !volume.header) return refuse("neither header nor radials");
    const auto is_31 = [](const Sweep& sweep) { return sweep.message_type == 31; };
    if (std::any_of(volume.sweeps.begin(), volume.sweeps.end(), is_31)) {
        if (!is_icao(volume.station)) {
            return refuse("the station '{}' is no ICAO identifier", volume.station);
        }
        if (!volume.block) return refuse("no position: the volume data block is missing");
    }
    for (std::size_t i = 0; i < volume.sweeps.size(); ++i) {
        if (Status checked = check_sweep(volume, i); !checked) return checked;
    }
    return {};
}

}  // namespace stormcellar::level2
