#include "level2/record_plan.h"

#include <algorithm>

#include "level2/fragment_builder.h"
#include "level2/part_decoder.h"

namespace stormcellar::level2 {
namespace {

constexpr int radials_per_record = 120;
// ICD 2620002 table XI: bit 0 of a cut's super resolution control.
constexpr unsigned half_degree_azimuth = 1;
constexpr std::uint64_t most_metadata_bytes = std::uint64_t{16} << 20;

int records_of(const VcpCut& cut) {
    const bool half_degree = (cut.super_resolution & half_degree_azimuth) != 0;
    return (half_degree ? 720 : 360) / radials_per_record;
}

std::optional<Vcp> pattern_in(const LdmPart& part) {
    const Selection everything;
    PartDecoder decoder{most_metadata_bytes, everything};
    const Fragment fragment = decoder.decode(part);
    // Radials among the metadata: an order of records that is not known.
    if (!fragment.pieces.empty() || fragment.behind.patterns.empty()) return std::nullopt;
    return fragment.behind.patterns.front();
}

}  // namespace

std::optional<RecordPlan> RecordPlan::make(std::span<const std::byte> bytes,
                                           const Selection& selection) {
    RecordPlan plan;
    LdmFramer framer{bytes};
    while (auto part = framer.next()) {
        if (part->kind == LdmPart::Kind::padding) continue;
        if (part->kind != LdmPart::Kind::record || part->cut || part->bad_length) {
            return std::nullopt;
        }
        plan.records_.push_back({*part, 0, false, false, true});
    }
    if (plan.records_.size() < 2) return std::nullopt;
    const auto pattern = pattern_in(plan.records_.front().part);
    if (!pattern) return std::nullopt;
    std::size_t at = 1;
    for (std::size_t i = 0; i < pattern->cuts.size(); ++i) {
        const int count = records_of(pattern->cuts[i]);
        for (int k = 0; k < count && at < plan.records_.size(); ++k, ++at) {
            Record& record = plan.records_[at];
            record.cut = static_cast<int>(i) + 1;
            record.first_of_cut = k == 0;
            record.last_of_cut = k + 1 == count;
            record.wanted = selection.wants_cut(record.cut);
        }
    }
    if (at < plan.records_.size()) return std::nullopt;  // more records than the pattern has
    plan.records_[1].wanted = true;      // the volume's block is that of the first radial
    plan.records_.back().wanted = true;  // shows whether the volume has ended
    return plan;
}

std::optional<LdmPart> RecordPlan::next() {
    while (next_ < records_.size() && !records_[next_].wanted)
        ++next_;
    if (next_ == records_.size()) return std::nullopt;
    return records_[next_++].part;
}

bool RecordPlan::agrees(const Fragment& fragment) {
    while (checked_ < records_.size() && !records_[checked_].wanted)
        ++checked_;
    if (checked_ == records_.size()) return false;
    const Record& record = records_[checked_++];
    if (fragment.failure != Fragment::Failure::none) return true;  // an error, whatever the plan
    if (record.cut == 0) return fragment.pieces.empty();
    if (fragment.pieces.size() != 1 || fragment.report.bytes_dropped != 0) return false;
    const Sweep& sweep = fragment.pieces.front().sweep;
    const bool is_first = begins_sweep(sweep.radials.front());
    const bool is_last = ends_sweep(sweep.radials.back());
    return sweep.elevation_number == record.cut && is_first == record.first_of_cut &&
           is_last == record.last_of_cut && fragment.behind.patterns.empty();
}

void RecordPlan::report(DecodeReport& report) const {
    for (const Record& record : records_) {
        if (record.wanted) continue;
        ++report.records_skipped;
        if (record.last_of_cut) ++report.sweeps_left_out;
        report.ldm_records = report.ldm_records.value_or(0) + 1;
        if (record.part.negative) {
            report.negative_control_words = report.negative_control_words.value_or(0) + 1;
        }
    }
}

}  // namespace stormcellar::level2
