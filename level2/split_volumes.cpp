#include <iterator>

#include "level2/decode.h"

namespace stormcellar::level2 {
namespace {

// The header of the volume that begins with this sweep.
std::optional<VolumeHeader> header_of(const DecodeReport& report, const Volume& whole,
                                      std::size_t first_sweep) {
    for (const auto& further : report.further_headers) {
        if (further.sweep == first_sweep) return further.header;
    }
    std::optional<VolumeHeader> header = whole.header;
    const Sweep& sweep = whole.sweeps[first_sweep];
    if (header && !sweep.radials.empty()) {
        const NexradTime time = nexrad_from_time(sweep.radials.front().time);
        header->date = time.day;
        header->ms = time.milliseconds;
    }
    return header;
}

void set_pattern(const DecodeReport& report, std::size_t first_sweep, Volume& volume) {
    for (const auto& pattern : report.further_patterns) {
        if (pattern.sweep != first_sweep) continue;
        volume.vcp_message = pattern.message;
        volume.vcp = pattern.vcp;
        volume.vcp_source = pattern.source;
    }
}

}  // namespace

std::vector<Volume> split_volumes(Decoded decoded) {
    Volume& whole = decoded.volume;
    std::vector<std::size_t> starts{0};
    for (const std::size_t start : decoded.report.further_volume_starts) {
        if (start > starts.back() && start < whole.sweeps.size()) starts.push_back(start);
    }
    std::vector<Volume> volumes;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        Volume& volume = volumes.emplace_back();
        volume.header = i == 0 ? whole.header : header_of(decoded.report, whole, starts[i]);
        volume.station = whole.station;
        volume.block = whole.block;
        if (i == 0) {
            volume.vcp_message = whole.vcp_message;
            volume.vcp = whole.vcp;
            volume.vcp_source = whole.vcp_source;
        } else {
            set_pattern(decoded.report, starts[i], volume);
        }
    }
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const std::size_t end = i + 1 < starts.size() ? starts[i + 1] : whole.sweeps.size();
        const auto from = whole.sweeps.begin() + static_cast<std::ptrdiff_t>(starts[i]);
        const auto to = whole.sweeps.begin() + static_cast<std::ptrdiff_t>(end);
        volumes[i].sweeps.assign(std::make_move_iterator(from), std::make_move_iterator(to));
    }
    return volumes;
}

}  // namespace stormcellar::level2
