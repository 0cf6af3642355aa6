#include "level2/decode/record_plan.h"

#include <set>

#include "level2/decode/fragment_builder.h"
#include "level2/decode/part_decoder.h"

namespace stormcellar::level2 {
namespace {

constexpr int radials_per_record = 120;
// ICD 2620002 table XI: bit 0 of the cut's super resolution control.
constexpr unsigned half_degree_azimuth = 1;
constexpr std::uint64_t most_metadata_bytes = std::uint64_t{16} << 20;

int records_of(const VcpCut& cut) {
    const bool half_degree = (cut.super_resolution & half_degree_azimuth) != 0;
    return (half_degree ? 720 : 360) / radials_per_record;
}

bool is_whole_record(const LdmPart& part) {
    return part.kind == LdmPart::Kind::record && !part.cut && !part.bad_length;
}

bool is_empty(const FragmentMarks& marks) {
    return marks.patterns.empty() && !marks.header;
}

std::optional<Vcp> pattern_in(const LdmPart& part) {
    const Selection everything;
    PartDecoder decoder{most_metadata_bytes, everything};
    const Fragment fragment = decoder.decode(part);
    // If the metadata record holds radials, the order of the records is unknown.
    if (!fragment.pieces.empty() || fragment.behind.patterns.empty()) return std::nullopt;
    return fragment.behind.patterns.front();
}

}  // namespace

// Returns the records that a whole volume of this pattern has. At most 51 cuts fit into the frame
// of the pattern.
std::vector<RecordPlan::Record> RecordPlan::expected(const Vcp& pattern,
                                                     const Selection& selection) {
    std::vector<Record> records(1);
    for (std::size_t i = 0; i < pattern.cuts.size(); ++i) {
        const int number = static_cast<int>(i) + 1;
        const int count = records_of(pattern.cuts[i]);
        for (int k = 0; k < count; ++k)
            records.push_back({{}, number, k == 0, k + 1 == count, selection.wants_cut(number)});
    }
    return records;
}

std::optional<RecordPlan> RecordPlan::make(std::span<const std::byte> bytes,
                                           const Selection& selection) {
    LdmFramer framer{bytes};
    const auto metadata = framer.next();
    if (!metadata || !is_whole_record(*metadata)) return std::nullopt;
    const auto pattern = pattern_in(*metadata);
    if (!pattern) return std::nullopt;
    RecordPlan plan;
    plan.records_ = expected(*pattern, selection);
    plan.records_.front().part = *metadata;
    std::size_t count = 1;
    while (const auto part = framer.next()) {
        if (part->kind == LdmPart::Kind::padding) continue;
        if (!is_whole_record(*part) || count == plan.records_.size()) return std::nullopt;
        plan.records_[count++].part = *part;
    }
    if (count < 2) return std::nullopt;
    plan.records_.resize(count);
    plan.want_witnesses();
    plan.records_[1].wanted = true;      // the first radial has the volume block
    plan.records_.back().wanted = true;  // shows if the volume has ended
    return plan;
}

// Marks the records on either side of the wanted cuts as wanted, because they prove that these cuts
// are complete.
void RecordPlan::want_witnesses() {
    std::vector<std::size_t> witnesses;
    for (std::size_t i = 1; i < records_.size(); ++i) {
        if (records_[i].wanted == records_[i - 1].wanted) continue;
        witnesses.push_back(records_[i].wanted ? i - 1 : i);
    }
    for (const std::size_t i : witnesses)
        records_[i].wanted = true;
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
    const std::size_t at = checked_++;
    const Record& record = records_[at];
    if (fragment.failure != Fragment::Failure::none) return true;  // fails with any plan
    if (record.cut == 0) return fragment.pieces.empty();
    if (fragment.pieces.size() != 1 || fragment.report.bytes_dropped != 0) return false;
    // A decode of the whole file takes the volume block and the station from the first radial that
    // has them, so the first record must have them.
    if (at == 1 && !fragment.block) return false;
    const Fragment::Piece& piece = fragment.pieces.front();
    const bool is_first = begins_sweep(piece.sweep.radials.front());
    const bool is_last = ends_sweep(piece.sweep.radials.back());
    return piece.sweep.elevation_number == record.cut && is_first == record.first_of_cut &&
           is_last == record.last_of_cut && is_empty(piece.before) && is_empty(fragment.behind);
}

void RecordPlan::report(DecodeReport& report) const {
    std::set<int> counted;  // cuts with a decoded record; the builder has counted their sweeps
    for (const Record& record : records_) {
        if (record.wanted) counted.insert(record.cut);
    }
    for (const Record& record : records_) {
        if (record.wanted) continue;
        ++report.records_skipped;
        if (record.last_of_cut && !counted.contains(record.cut)) ++report.sweeps_left_out;
        report.ldm_records = report.ldm_records.value_or(0) + 1;
        if (record.part.negative) {
            report.negative_control_words = report.negative_control_words.value_or(0) + 1;
        }
    }
}

}  // namespace stormcellar::level2
