#include "tests/level2/same_volume.h"

namespace stormcellar::level2 {

std::string difference(const Decoded& a, const Decoded& b) {
    if (std::string where = difference(a.volume, b.volume); !where.empty()) return where;
    const DecodeReport& x = a.report;
    const DecodeReport& y = b.report;
    if (x.container != y.container) return "container";
    if (x.ldm_records != y.ldm_records) return "ldm_records";
    if (x.negative_control_words != y.negative_control_words) return "negative_control_words";
    if (x.message_bytes != y.message_bytes) return "message_bytes";
    if (x.message_counts != y.message_counts) return "message_counts";
    if (x.bytes_dropped != y.bytes_dropped) return "bytes_dropped";
    if (x.complete != y.complete) return "complete";
    if (x.further_volume_starts != y.further_volume_starts) return "further_volume_starts";
    if (x.message_station != y.message_station) return "message_station";
    if (x.corruption.has_value() != y.corruption.has_value()) return "corruption";
    if (x.corruption && x.corruption->offset != y.corruption->offset) return "corruption's offset";
    if (x.problems.size() != y.problems.size()) return "number of problems";
    for (std::size_t i = 0; i < x.problems.size(); ++i) {
        const Problem& p = x.problems[i];
        const Problem& q = y.problems[i];
        if (p.code != q.code || p.text() != q.text() || p.offset != q.offset) {
            return "problem " + p.text() + " / " + q.text();
        }
    }
    return {};
}

}  // namespace stormcellar::level2
