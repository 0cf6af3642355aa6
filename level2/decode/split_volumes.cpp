#include <algorithm>
#include <iterator>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {
namespace {

// The sweeps of one of the volumes, and its index in the report.
struct Share {
    std::size_t begin = 0;
    std::size_t end = 0;
    // index in further_volume_starts; none for the first volume
    std::optional<std::size_t> start;
};

// Returns the volumes that have sweeps, at least one. If several volumes begin at the same sweep,
// only the last of them has sweeps.
std::vector<Share> shares_of(const DecodeReport& report, std::size_t sweeps) {
    std::vector<Share> shares(1);
    const std::vector<std::size_t>& starts = report.further_volume_starts;
    for (std::size_t i = 0; i < starts.size() && starts[i] < sweeps; ++i) {
        if (starts[i] < shares.back().begin) continue;  // no decoder makes such a report
        if (starts[i] > shares.back().begin) {
            shares.back().end = starts[i];
            shares.emplace_back();
        }
        shares.back() = {starts[i], sweeps, i};
    }
    shares.back().end = sweeps;
    return shares;
}

// Returns the header of the volume that begins with this sweep.
std::optional<VolumeHeader> header_of(const DecodeReport& report, const Volume& whole,
                                      const Share& share) {
    if (!share.start) return whole.header;
    const auto& headers = report.further_headers;
    const auto own = std::lower_bound(
        headers.begin(), headers.end(), *share.start,
        [](const auto& further, std::size_t start) { return further.start < start; });
    if (own != headers.end() && own->start == *share.start) return own->header;
    std::optional<VolumeHeader> header = whole.header;
    const Sweep& sweep = whole.sweeps[share.begin];
    if (header && !sweep.radials.empty()) {
        const NexradTime time = nexrad_from_time(sweep.radials.front().time);
        header->date = time.day;
        header->ms = time.milliseconds;
    }
    return header;
}

void set_pattern(const DecodeReport& report, const Volume& whole, const Share& share,
                 Volume& volume) {
    if (!share.start) {
        volume.vcp_message = whole.vcp_message;
        volume.vcp = whole.vcp;
        volume.vcp_source = whole.vcp_source;
    } else if (*share.start < report.further_patterns.size()) {
        const auto& pattern = report.further_patterns[*share.start];
        volume.vcp_message = pattern.message;
        volume.vcp = pattern.vcp;
        volume.vcp_source = pattern.source;
    }
}

}  // namespace

std::vector<Volume> split_volumes(Decoded decoded) {
    Volume& whole = decoded.volume;
    const std::vector<Share> shares = shares_of(decoded.report, whole.sweeps.size());
    std::vector<Volume> volumes;
    for (const Share& share : shares) {
        Volume& volume = volumes.emplace_back();
        volume.header = header_of(decoded.report, whole, share);
        volume.station = whole.station;
        volume.block = whole.block;
        set_pattern(decoded.report, whole, share, volume);
    }
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const auto from = whole.sweeps.begin() + static_cast<std::ptrdiff_t>(shares[i].begin);
        const auto to = whole.sweeps.begin() + static_cast<std::ptrdiff_t>(shares[i].end);
        volumes[i].sweeps.assign(std::make_move_iterator(from), std::make_move_iterator(to));
    }
    return volumes;
}

}  // namespace stormcellar::level2
