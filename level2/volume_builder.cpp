#include "level2/volume_builder.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "level2/archive_header.h"
#include "level2/fragment_builder.h"
#include "level2/sweep_rows.h"
#include "level2/volume_checks.h"

namespace stormcellar::level2 {
namespace {

// Rows to make room for, so that arrays of an ordinary sweep are never moved or too large.
constexpr std::size_t radials_half_degree = 720;
constexpr std::size_t radials_one_degree = 368;
// A volume has some hundreds.
constexpr std::uint64_t most_records = 100'000;

VcpSource source_of(const Vcp& vcp) {
    return vcp.message_type == 7 ? VcpSource::message_7 : VcpSource::message_5;
}

std::size_t expected_radials(float azimuth_spacing_deg) {
    return azimuth_spacing_deg == 0.5F ? radials_half_degree : radials_one_degree;
}

// Drops the radials for which `drop` holds, with their rows; the moments stay.
void drop_radials(Sweep& sweep, const std::vector<bool>& drop) {
    Sweep kept = sweep;
    kept.radials.clear();
    for (SweepMoment& moment : kept.moments)
        moment = rows::empty_like(moment);
    for (std::size_t i = 0; i < sweep.radials.size(); ++i) {
        if (drop[i]) continue;
        kept.radials.push_back(sweep.radials[i]);
        for (std::size_t m = 0; m < sweep.moments.size(); ++m) {
            const SweepMoment& from = sweep.moments[m];
            SweepMoment row = rows::empty_like(from);
            const auto stride = static_cast<std::ptrdiff_t>(from.gate_stride);
            const auto at = static_cast<std::ptrdiff_t>(i) * stride;
            row.gate_counts = {from.gate_counts[i]};
            if (from.word_size_bits == 8) {
                row.codes8.assign(from.codes8.begin() + at, from.codes8.begin() + at + stride);
            } else {
                row.codes16.assign(from.codes16.begin() + at, from.codes16.begin() + at + stride);
            }
            rows::append(kept.moments[m], row);
        }
    }
    std::erase_if(kept.moments, [](const SweepMoment& moment) {
        return std::all_of(moment.gate_counts.begin(), moment.gate_counts.end(),
                           [](std::uint16_t gates) { return gates == 0; });
    });
    sweep = std::move(kept);
}

bool continues(int elevation_number, int message_type, const Sweep& next) {
    return !begins_sweep(next.radials.front()) && elevation_number == next.elevation_number &&
           message_type == next.message_type;
}

}  // namespace

bool continues_sweep(const Fragment::Piece& previous, const Fragment::Piece& piece) {
    return continues(previous.sweep.elevation_number, previous.sweep.message_type, piece.sweep);
}

bool VolumeBuilder::take_room(std::uint64_t bytes) {
    if (bytes > limit_bytes_ - taken_bytes_) return false;
    taken_bytes_ += bytes;
    return true;
}

void VolumeBuilder::set_pattern(Vcp vcp) {
    if (!volume_.vcp_message) {
        volume_.vcp_message = vcp;
        volume_.vcp = vcp.pattern_number;
        volume_.vcp_source = source_of(vcp);
    }
    current_vcp_ = std::move(vcp);
    vcp_is_new_ = true;
}

void VolumeBuilder::note_marks(FragmentMarks marks) {
    for (Vcp& vcp : marks.patterns)
        set_pattern(std::move(vcp));
    if (marks.header) pending_header_ = std::move(marks.header);
}

void VolumeBuilder::note_facts(const Fragment& fragment) {
    for (const Fragment::Piece& piece : fragment.pieces)
        note_marks(piece.before);
    note_marks(fragment.behind);
    note_volume_facts(fragment);
}

void VolumeBuilder::note_volume_facts(const Fragment& fragment) {
    if (report_.message_station.empty()) report_.message_station = fragment.station;
    if (!volume_.block) volume_.block = fragment.block;
    if (!volume_.vcp && fragment.vcp != 0) {
        volume_.vcp = fragment.vcp;
        volume_.vcp_source = VcpSource::radial;
    }
}

// What is known of the pattern of a volume that begins with this piece. An old message 5 counts
// only as long as the radials name its pattern.
DecodeReport::FurtherPattern VolumeBuilder::pattern_of(const Fragment::Piece& piece) {
    if (current_vcp_ && !vcp_is_new_ && piece.vcp != 0 &&
        piece.vcp != current_vcp_->pattern_number) {
        current_vcp_.reset();
    }
    DecodeReport::FurtherPattern pattern{volume_.sweeps.size(), current_vcp_, {}, VcpSource::none};
    if (current_vcp_) {
        pattern.vcp = current_vcp_->pattern_number;
        pattern.source = source_of(*current_vcp_);
    } else if (piece.vcp != 0) {
        pattern.vcp = piece.vcp;
        pattern.source = VcpSource::radial;
    }
    return pattern;
}

bool VolumeBuilder::begins_sweep_here(const Fragment::Piece& piece) const {
    return !previous_ || pending_header_ ||
           !continues(previous_->elevation_number, previous_->message_type, piece.sweep);
}

bool VolumeBuilder::begins_volume(const Fragment::Piece& piece) const {
    if (!previous_) return false;
    const bool marked = status_of(piece.sweep.radials.front()) == RadialStatus::start_of_volume;
    if (marked || pending_header_) return true;
    // A pattern's cuts only count upwards, so a lower number is another pass, even where the
    // radials that would say so are lost.
    return piece.sweep.elevation_number < previous_->elevation_number ||
           (previous_->ended_volume && piece.sweep.elevation_number == previous_->elevation_number);
}

void VolumeBuilder::begin_volume(const Fragment::Piece& piece) {
    report_.further_volume_starts.push_back(volume_.sweeps.size());
    report_.further_patterns.push_back(pattern_of(piece));
    if (pending_header_) {
        report_.further_headers.push_back({volume_.sweeps.size(), *pending_header_});
    }
}

Sweep& VolumeBuilder::begin_sweep(const Sweep& from) {
    Sweep& sweep = volume_.sweeps.emplace_back();
    sweep.elevation_number = from.elevation_number;
    sweep.message_type = from.message_type;
    sweep.azimuth_spacing_deg = from.azimuth_spacing_deg;
    const auto cut = static_cast<std::size_t>(from.elevation_number) - 1;
    if (from.elevation_number >= 1 && current_vcp_ && cut < current_vcp_->cuts.size()) {
        sweep.vcp_elevation_deg = current_vcp_->cuts[cut].elevation_deg;
    }
    sweep.radials.reserve(expected_radials(from.azimuth_spacing_deg));
    return sweep;
}

void VolumeBuilder::tidy_last_sweep() {
    if (!sweep_is_open_) return;
    Sweep& sweep = volume_.sweeps.back();
    for (SweepMoment& moment : sweep.moments) {
        rows::pad(moment, sweep.radials.size());
        rows::release_unused(moment);
    }
    if (sweep.radials.capacity() > 2 * sweep.radials.size()) sweep.radials.shrink_to_fit();
}

void VolumeBuilder::end_sweep() {
    tidy_last_sweep();
    sweep_is_open_ = false;
}

// Each fragment holds few enough kinds of a moment, but together they can be too many.
void VolumeBuilder::refuse_surplus_kinds(const Sweep& sweep, Sweep& from) {
    std::vector<bool> drop(from.radials.size(), false);
    std::vector<const SweepMoment*> accepted;
    for (const SweepMoment& moment : sweep.moments)
        accepted.push_back(&moment);
    for (const SweepMoment& moment : from.moments) {
        const auto is_same = [&](const SweepMoment* m) { return rows::same_kind(*m, moment); };
        const auto of_moment = [&](const SweepMoment* m) { return m->moment == moment.moment; };
        if (std::any_of(accepted.begin(), accepted.end(), is_same)) continue;
        if (std::count_if(accepted.begin(), accepted.end(), of_moment) < most_kinds_of_a_moment) {
            accepted.push_back(&moment);
            continue;
        }
        for (std::size_t i = 0; i < moment.gate_counts.size(); ++i)
            drop[i] = drop[i] || moment.gate_counts[i] != 0;
    }
    if (std::find(drop.begin(), drop.end(), true) == drop.end()) return;
    const std::uint64_t row_bytes = sizeof(Radial) + rows::bytes_per_row(from);
    const auto dropped = static_cast<std::uint64_t>(std::count(drop.begin(), drop.end(), true));
    for (SweepMoment& moment : from.moments)
        rows::pad(moment, from.radials.size());
    drop_radials(from, drop);
    report().damage("bad_radial", "no sweep holds so many kinds of a moment", report_.message_bytes,
                    dropped * row_bytes);
}

bool VolumeBuilder::append_moment(Sweep& sweep, std::size_t radials_before,
                                  const SweepMoment& from) {
    const auto same = [&](const SweepMoment& moment) { return rows::same_kind(moment, from); };
    auto moment = std::find_if(sweep.moments.begin(), sweep.moments.end(), same);
    if (moment == sweep.moments.end()) {
        const bool first = sweep.find(from.moment) == nullptr;
        sweep.moments.push_back(rows::empty_like(from));
        moment = sweep.moments.end() - 1;
        if (first) rows::reserve(*moment, expected_radials(sweep.azimuth_spacing_deg));
        if (!take_room(radials_before * rows::bytes_per_row(*moment))) return false;
    }
    if (from.gate_stride > moment->gate_stride) {
        const std::int32_t stride = rows::grown_stride(*moment, from.gate_stride);
        const auto more = static_cast<std::uint64_t>(stride - moment->gate_stride);
        if (!take_room(radials_before * more * rows::bytes_per_code(*moment))) return false;
        rows::set_stride(*moment, stride);
    }
    rows::pad(*moment, radials_before);
    rows::append(*moment, from);
    return true;
}

bool VolumeBuilder::append_rows(Sweep& sweep, const Sweep& from) {
    const std::size_t before = sweep.radials.size();
    const std::uint64_t own_bytes = rows::bytes_per_row(from);
    if (!take_room(from.radials.size() * (sizeof(Radial) + own_bytes))) return false;
    sweep.radials.insert(sweep.radials.end(), from.radials.begin(), from.radials.end());
    for (const SweepMoment& moment : from.moments) {
        if (!append_moment(sweep, before, moment)) return false;
    }
    // The kinds that these radials lack get rows all the same.
    return take_room(from.radials.size() * (rows::bytes_per_row(sweep) - own_bytes));
}

bool VolumeBuilder::append_piece(Fragment::Piece piece) {
    note_marks(std::move(piece.before));
    const bool begins = begins_sweep_here(piece);
    if (begins) {
        if (begins_volume(piece)) begin_volume(piece);
        pending_header_.reset();
        vcp_is_new_ = false;
        end_sweep();
    }
    Sweep& from = piece.sweep;
    previous_ = Previous{from.elevation_number, from.message_type, ends_sweep(from.radials.back()),
                         status_of(from.radials.back()) == RadialStatus::end_of_volume};
    if (piece.left_out) {
        if (begins) ++report_.sweeps_left_out;
        return true;
    }
    sweep_is_open_ = true;
    if (!begins) {
        refuse_surplus_kinds(volume_.sweeps.back(), from);
        return append_rows(volume_.sweeps.back(), from);
    }
    Sweep& sweep = begin_sweep(from);
    const std::size_t count = from.radials.size();
    if (2 * count < expected_radials(from.azimuth_spacing_deg)) {
        return take_room(sizeof(Sweep)) && append_rows(sweep, from);
    }
    // Nearly all of the sweep already: its arrays are taken as they are.
    sweep.radials = std::move(from.radials);
    sweep.moments = std::move(from.moments);
    return take_room(sizeof(Sweep) + count * (sizeof(Radial) + rows::bytes_per_row(sweep)));
}

std::string VolumeBuilder::station(const std::string& fallback) const {
    if (!report_.message_station.empty()) return report_.message_station;
    if (volume_.header && !volume_.header->icao.empty()) return volume_.header->icao;
    return fallback;
}

Volume VolumeBuilder::facts(const std::string& fallback_station) const {
    Volume facts;
    facts.header = volume_.header;
    facts.station = station(fallback_station);
    facts.block = volume_.block;
    facts.vcp_message = volume_.vcp_message;
    facts.vcp = volume_.vcp;
    facts.vcp_source = volume_.vcp_source;
    return facts;
}

std::size_t VolumeBuilder::close_sweeps() {
    if (!sweep_is_open_ || previous_->ended_sweep) {
        tidy_last_sweep();
        return volume_.sweeps.size();
    }
    return volume_.sweeps.size() - 1;
}

std::span<const std::byte> VolumeBuilder::begin_stream(std::span<const std::byte> bytes) {
    auto header = read_archive_header(bytes);
    if (!header) {
        report().add(Severity::note, "no_volume_header", "no 24-byte volume header");
        return bytes;
    }
    set_header(std::move(*header));
    return bytes.subspan(archive_header_bytes);
}

Status VolumeBuilder::too_much_output() const {
    return fail(ErrorCode::unsupported, "decompresses to more than the limit of {} bytes",
                limit_bytes_);
}

Status VolumeBuilder::count_output(std::uint64_t bytes) {
    if (bytes > limit_bytes_ - output_bytes_) return too_much_output();
    output_bytes_ += bytes;
    return {};
}

Status VolumeBuilder::append(Fragment fragment) {
    const auto too_large_arrays = [&]() -> Status {
        return fail(ErrorCode::unsupported, "its arrays take more than the limit of {} bytes",
                    limit_bytes_);
    };
    switch (fragment.failure) {
        case Fragment::Failure::none:
            break;
        case Fragment::Failure::no_memory:
            return fail(ErrorCode::unsupported, "it takes more memory than there is");
        case Fragment::Failure::too_much_output:
            return too_much_output();
        case Fragment::Failure::too_large_arrays:
            return too_large_arrays();
    }
    if (Status counted = count_output(fragment.output_bytes); !counted) return counted;
    if (report_.ldm_records.value_or(0) + fragment.report.ldm_records.value_or(0) > most_records) {
        return fail(ErrorCode::unsupported, "more than {} LDM records", most_records);
    }
    cut_ = cut_ || fragment.cut;
    note_volume_facts(fragment);
    for (Fragment::Piece& piece : fragment.pieces) {
        if (!append_piece(std::move(piece))) return too_large_arrays();
        piece = {};
    }
    note_marks(std::move(fragment.behind));
    report().append(std::move(fragment.report));
    return {};
}

Result<Decoded> VolumeBuilder::finish(const std::string& fallback_station) {
    const bool last_is_newest = sweep_is_open_;
    end_sweep();
    const auto& counts = report_.message_counts;
    const bool anything = std::any_of(counts.begin(), counts.end(),
                                      [](const auto& count) { return count.first != 0; });
    if (!anything) {
        return fail(
            cut_ ? ErrorCode::truncated : ErrorCode::corrupt, "nothing in it is whole: {}",
            report_.corruption ? report_.corruption->reason : "neither radials nor metadata");
    }
    volume_.station = station(fallback_station);
    const bool ended = volume_has_ended();
    const bool all_cuts = report_.sweeps_left_out == 0 && report_.records_skipped == 0;
    const VolumeFacts facts{
        previous_.has_value(), ended, all_cuts, last_is_newest, report_.further_volume_starts,
        report_.rda_status};
    const bool gaps = check_volume(volume_, facts, report());
    report_.complete = ended && !gaps && report_.bytes_dropped == 0 && report_.errors == 0;
    report().finish();
    return Decoded{std::move(volume_), std::move(report_)};
}

}  // namespace stormcellar::level2
