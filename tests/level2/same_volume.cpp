#include "tests/level2/same_volume.h"

#include <algorithm>
#include <tuple>

namespace stormcellar::level2 {
namespace {

// Compares headers, patterns and starts of all volumes but the first.
std::string further_difference(const DecodeReport& x, const DecodeReport& y) {
    const bool same_headers = std::equal(
        x.further_headers.begin(), x.further_headers.end(), y.further_headers.begin(),
        y.further_headers.end(), [](const auto& a, const auto& b) {
            return std::tie(a.sweep, a.start, a.header.filename, a.header.date, a.header.ms) ==
                   std::tie(b.sweep, b.start, b.header.filename, b.header.date, b.header.ms);
        });
    if (!same_headers) return "further_headers";
    const bool same_patterns =
        std::equal(x.further_patterns.begin(), x.further_patterns.end(), y.further_patterns.begin(),
                   y.further_patterns.end(), [](const auto& a, const auto& b) {
                       return a.sweep == b.sweep && a.vcp == b.vcp && a.source == b.source &&
                              a.message.has_value() == b.message.has_value();
                   });
    return same_patterns ? "" : "further_patterns";
}

}  // namespace

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
    if (x.radial_compression != y.radial_compression) return "radial_compression";
    if (x.errors != y.errors) return "errors";
    if (x.problems_left_out != y.problems_left_out) return "problems_left_out";
    if (x.sweeps_left_out != y.sweeps_left_out) return "sweeps_left_out";
    if (std::string where = further_difference(x, y); !where.empty()) return where;
    if (x.corruption.has_value() != y.corruption.has_value()) return "corruption";
    if (x.corruption && x.corruption->offset != y.corruption->offset) return "corruption's offset";
    if (x.corruption && x.corruption->reason != y.corruption->reason) return "corruption's reason";
    if (x.problems.size() != y.problems.size()) return "number of problems";
    for (std::size_t i = 0; i < x.problems.size(); ++i) {
        const Problem& p = x.problems[i];
        const Problem& q = y.problems[i];
        if (p.code != q.code || p.severity != q.severity || p.text() != q.text() ||
            p.offset != q.offset) {
            return "problem " + p.text() + " / " + q.text();
        }
    }
    return {};
}

}  // namespace stormcellar::level2
