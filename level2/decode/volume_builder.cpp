#include "level2/decode/volume_builder.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "level2/containers/archive_header.h"
#include "level2/decode/fragment_builder.h"
#include "level2/decode/late_radials.h"
#include "level2/decode/sweep_rows.h"
#include "level2/decode/volume_checks.h"
#include "stormcellar/level2/live_sweep.h"

namespace stormcellar::level2 {
namespace {

// Rows reserved at first, so that the arrays of an ordinary sweep never grow and waste little
// memory.
constexpr std::size_t radials_half_degree = 720;
constexpr std::size_t radials_one_degree = 368;
// A real volume has at most some hundreds of records.
constexpr std::uint64_t most_records = 100'000;

VcpSource source_of(const Vcp& vcp) {
    return vcp.message_type == 7 ? VcpSource::message_7 : VcpSource::message_5;
}

std::size_t expected_radials(float azimuth_spacing_deg) {
    return azimuth_spacing_deg == 0.5F ? radials_half_degree : radials_one_degree;
}

std::uint64_t held_by(const Sweep& sweep) {
    std::uint64_t bytes =
        bytes_of(sweep) + (sweep.radials.capacity() - sweep.radials.size()) * sizeof(Radial);
    for (const SweepMoment& moment : sweep.moments)
        bytes += rows::idle_bytes(moment);
    return bytes;
}

// Returns true if this radial of a piece may be late, judged by the radial before it.
bool falls_back(const Sweep& sweep, std::size_t radial) {
    const Radial& before = sweep.radials[radial - 1];
    const Radial& own = sweep.radials[radial];
    return own.azimuth_number <= before.azimuth_number && goes_back(own, before.time);
}

// Sets `end` if the radial ends the volume, and resets it if the radial is not older than the end.
void note_end_of_volume(std::optional<UtcTime>& end, const Radial& radial) {
    if (end && *end <= radial.time) end.reset();
    if (status_of(radial) == RadialStatus::end_of_volume) end = radial.time;
}

bool continues(int elevation_number, int message_type, const Sweep& next) {
    return !begins_sweep(next.radials.front()) && elevation_number == next.elevation_number &&
           message_type == next.message_type;
}

}  // namespace

bool continues_sweep(const Fragment::Piece& previous, const Fragment::Piece& piece) {
    return continues(previous.sweep.elevation_number, previous.sweep.message_type, piece.sweep);
}

void VolumeBuilder::set_pattern(Vcp vcp) {
    if (!volume_.vcp_message) {
        volume_.vcp_message = vcp;
        volume_.vcp = vcp.pattern_number;
        volume_.vcp_source = source_of(vcp);
    }
    current_vcp_ = std::move(vcp);
    vcp_is_new_ = true;
    if (!header_is_late_) return;
    for (Sweep& sweep : volume_.sweeps) {
        if (!sweep.vcp_elevation_deg) sweep.vcp_elevation_deg = elevation_of_cut(sweep);
    }
}

// Returns the fixed angle that the current pattern gives for the sweep's cut.
std::optional<float> VolumeBuilder::elevation_of_cut(const Sweep& sweep) const {
    const auto cut = static_cast<std::size_t>(sweep.elevation_number) - 1;
    if (sweep.elevation_number < 1 || !current_vcp_ || cut >= current_vcp_->cuts.size()) return {};
    return current_vcp_->cuts[cut].elevation_deg;
}

bool VolumeBuilder::note_marks(FragmentMarks marks) {
    for (Vcp& vcp : marks.patterns) {
        if (!room_.add(bytes_of(vcp))) return false;
        set_pattern(std::move(vcp));
    }
    if (marks.header) note_header(std::move(*marks.header));
    return true;
}

// If the first header comes after the first radials but is not newer than they are, it is the late
// header of their volume. Every other header is pending until the next radial.
void VolumeBuilder::note_header(VolumeHeader header) {
    constexpr std::chrono::seconds apart{15};  // of the header and the first radial
    const bool is_first = !volume_.header && report_.further_volume_starts.empty();
    if (is_first && first_time_ && header.time() <= *first_time_ + apart) {
        volume_.header = std::move(header);
        header_is_late_ = true;
    } else {
        pending_header_ = std::move(header);
    }
}

void VolumeBuilder::note_facts(const Fragment& fragment) {
    for (const Fragment::Piece& piece : fragment.pieces)
        (void)note_marks(piece.before);
    (void)note_marks(fragment.behind);
    note_volume_facts(fragment);
}

void VolumeBuilder::note_volume_facts(const Fragment& fragment) {
    if (report_.message_station.empty()) {
        report_.message_station = fragment.station;
    } else if (!fragment.station.empty() && fragment.station != report_.message_station) {
        report().oddity(Severity::note, "odd_radials",
                        "radials name another station than the first", report_.message_bytes);
    }
    if (!volume_.block) volume_.block = fragment.block;
    if (!volume_.vcp && fragment.vcp != 0) {
        volume_.vcp = fragment.vcp;
        volume_.vcp_source = VcpSource::radial;
    }
}

// Returns the pattern of a further volume that begins with this piece. A message 5 that came before
// the volume's first sweep counts only if the radials name the same pattern.
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
    const Radial& first = piece.sweep.radials.front();
    if (pending_header_) return true;
    // If records come in the wrong order, elevation numbers fall too, but time goes back. In that
    // case only a second start of a volume begins another volume.
    const bool marked = status_of(first) == RadialStatus::start_of_volume;
    if (goes_back(first, previous_->time)) return marked && start_has_come_;
    if (marked) return true;
    // The cuts of a pattern only count upward, so a lower number begins another pass, even if the
    // radials that mark its start are lost.
    return piece.sweep.elevation_number < previous_->elevation_number ||
           (previous_->end_of_volume &&
            piece.sweep.elevation_number == previous_->elevation_number);
}

bool VolumeBuilder::begin_volume(const Fragment::Piece& piece) {
    const std::size_t sweep = volume_.sweeps.size();
    DecodeReport::FurtherPattern pattern = pattern_of(piece);
    // Count a pattern and a block for each volume, because split_volumes() copies them.
    const std::uint64_t bytes = sizeof(Volume) + sizeof(pattern) +
                                sizeof(DecodeReport::FurtherHeader) +
                                (pattern.message ? bytes_of(*pattern.message) : 0) +
                                (volume_.block ? volume_.block->rest.size() : 0);
    if (!room_.add(bytes)) return false;
    if (pending_header_) {
        report_.further_headers.push_back(
            {sweep, *pending_header_, report_.further_volume_starts.size()});
    }
    report_.further_volume_starts.push_back(sweep);
    late_place_.reset();
    start_has_come_ = false;
    report_.further_patterns.push_back(std::move(pattern));
    return true;
}

// Begins a sweep that has the facts of the piece and the fixed angle of its cut, but no radials.
Sweep& VolumeBuilder::begin_sweep(const Sweep& from) {
    Sweep& sweep = volume_.sweeps.emplace_back();
    sweep.elevation_number = from.elevation_number;
    sweep.message_type = from.message_type;
    sweep.azimuth_spacing_deg = from.azimuth_spacing_deg;
    sweep.vcp_elevation_deg = elevation_of_cut(from);
    sweep.radials.reserve(expected_radials(from.azimuth_spacing_deg));
    return sweep;
}

void VolumeBuilder::tidy_last_sweep() {
    if (sweep_is_open_) rows::make_whole(volume_.sweeps.back());
}

void VolumeBuilder::end_sweep() {
    tidy_last_sweep();
    sweep_is_open_ = false;
}

// Counts the bytes that the open sweep takes with the radials of `from`. Returns false if they
// exceed a limit.
bool VolumeBuilder::make_room_for(const Sweep& sweep, const Sweep& from) {
    std::size_t next = sweep.moments.size();
    for (const SweepMoment& moment : from.moments) {
        const auto same = [&](const SweepMoment& m) { return rows::same_kind(m, moment); };
        const auto there = std::find_if(sweep.moments.begin(), sweep.moments.end(), same);
        const std::size_t number = there == sweep.moments.end()
                                       ? next++
                                       : static_cast<std::size_t>(there - sweep.moments.begin());
        const auto gates = *std::max_element(moment.gate_counts.begin(), moment.gate_counts.end());
        if (!room_.widen(number, gates, rows::bytes_per_code(moment))) return false;
    }
    return room_.add_radials(from.radials.size());
}

// Appends the rows of a piece to the open sweep. The rows of each moment go to the moment of the
// same kind in the open sweep, or begin a new moment. Rows are widened if the piece has more gates,
// and padded for radials that lack the kind.
void VolumeBuilder::append_rows(Sweep& sweep, const Sweep& from) {
    const std::size_t before = sweep.radials.size();
    sweep.radials.insert(sweep.radials.end(), from.radials.begin(), from.radials.end());
    for (const SweepMoment& moment : from.moments) {
        const auto same = [&](const SweepMoment& m) { return rows::same_kind(m, moment); };
        auto to = std::find_if(sweep.moments.begin(), sweep.moments.end(), same);
        if (to == sweep.moments.end()) {
            const bool first = sweep.find(moment.moment) == nullptr;
            sweep.moments.push_back(rows::empty_like(moment));
            to = sweep.moments.end() - 1;
            if (first) rows::reserve(*to, expected_radials(sweep.azimuth_spacing_deg));
        }
        if (moment.gate_stride > to->gate_stride) {
            rows::set_stride(*to, rows::grown_stride(*to, moment.gate_stride));
        }
        rows::pad(*to, before);
        rows::append(*to, moment);
    }
}

// Appends a piece whose first radial is not late, or has no place in an earlier sweep. The piece
// continues the open sweep or begins a new one, and perhaps a new volume. A piece of a cut that is
// not selected is only counted.
bool VolumeBuilder::append_in_order(Fragment::Piece piece) {
    Sweep& from = piece.sweep;
    const Radial& first = from.radials.front();
    const Radial& last = from.radials.back();
    const bool begins = begins_sweep_here(piece);
    std::optional<UtcTime> end_of_volume;
    if (previous_) end_of_volume = previous_->end_of_volume;
    if (begins) {
        const bool begins_another = begins_volume(piece);
        if (begins_another && !begin_volume(piece)) return false;
        if (begins_another) end_of_volume.reset();
        const bool goes_on = !previous_ || begins_another || !goes_back(first, previous_->time);
        is_disordered_ = is_disordered_ || !goes_on;
        pending_header_.reset();
        vcp_is_new_ = false;
        end_sweep();
        if (!room_.begin_sweep()) return false;
    }
    if (status_of(first) == RadialStatus::start_of_volume) start_has_come_ = true;
    for (const Radial& radial : from.radials)
        note_end_of_volume(end_of_volume, radial);
    if (!first_time_) first_time_ = first.time;
    previous_ = Previous{from.elevation_number, from.message_type, ends_sweep(last),
                         end_of_volume,         last.time,         last.azimuth_number};
    if (piece.left_out) {
        if (begins) ++report_.sweeps_left_out;
        return true;
    }
    sweep_is_open_ = true;
    Sweep& sweep = begins ? begin_sweep(from) : volume_.sweeps.back();
    if (!make_room_for(sweep, from)) return false;
    if (begins && 2 * from.radials.size() >= expected_radials(from.azimuth_spacing_deg)) {
        // The piece has at least half of the sweep, so take over its arrays without a copy.
        sweep.radials = std::move(from.radials);
        sweep.moments = std::move(from.moments);
    } else {
        append_rows(sweep, from);
    }
    return true;
}

// Returns true if a radial is older than the previous radial and does not continue its sweep,
// because its azimuth number does not rise or it belongs to another sweep. The answer does not
// depend on where fragments end.
bool VolumeBuilder::is_late(const Sweep& sweep, std::size_t radial) const {
    const Radial& own = sweep.radials[radial];
    if (!previous_ || !goes_back(own, previous_->time)) return false;
    return pending_header_ || begins_sweep(own) ||
           own.azimuth_number <= previous_->azimuth_number ||
           previous_->elevation_number != sweep.elevation_number ||
           previous_->message_type != sweep.message_type;
}

// Appends a piece. Late radials go where they belong; the other radials are appended.
bool VolumeBuilder::append_piece(Fragment::Piece piece) {
    if (!note_marks(std::move(piece.before))) return false;
    if (piece.left_out) {
        const bool older = !pending_header_ && is_late(piece.sweep, 0);
        return older || append_in_order(std::move(piece));
    }
    const std::size_t count = piece.sweep.radials.size();
    for (std::size_t at = 0; at < count;) {
        const Result<std::size_t> late = take_late(piece.sweep, at);
        if (!late) late_failure_ = pass_on(late);
        if (!late) return false;
        at = *late;
        if (at == count) break;
        std::size_t end = at + 1;
        while (end < count && !falls_back(piece.sweep, end))
            ++end;
        Fragment::Piece part;
        part.vcp = piece.vcp;
        const bool is_all = at == 0 && end == count;
        part.sweep = is_all ? std::move(piece.sweep) : rows::part_of(piece.sweep, at, end);
        if (!append_in_order(std::move(part))) return false;
        at = end;
    }
    return true;
}

std::string VolumeBuilder::station(const std::string& fallback) const {
    if (volume_.header && !volume_.header->icao.empty()) return volume_.header->icao;
    return report_.message_station.empty() ? fallback : report_.message_station;
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

std::uint64_t VolumeBuilder::held_bytes() const {
    std::uint64_t bytes = 0;
    for (const Sweep& sweep : volume_.sweeps)
        bytes += held_by(sweep);
    return bytes;
}

std::uint64_t VolumeBuilder::open_sweep_bytes() const {
    return sweep_is_open_ ? held_by(volume_.sweeps.back()) : 0;
}

std::size_t VolumeBuilder::closed_sweeps() const {
    return volume_.sweeps.size() - (sweep_is_open_ ? 1 : 0);
}

Sweep VolumeBuilder::whole_sweep(std::size_t index) const {
    Sweep sweep = volume_.sweeps[index];
    if (sweep_is_open_ && index + 1 == volume_.sweeps.size()) rows::make_whole(sweep);
    return sweep;
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

Status VolumeBuilder::hold(std::uint64_t bytes) {
    if (room_.add(bytes)) return {};
    return fail(ErrorCode::unsupported, "its contents take more than the limit of {} bytes",
                array_limit_bytes_);
}

// Returns false if the arrays exceed their limit.
bool VolumeBuilder::append_all(Fragment& fragment) {
    // Check the bytes of the whole fragment before its pieces are joined.
    if (fragment.array_bytes > arrays_left()) return false;
    for (Fragment::Piece& piece : fragment.pieces) {
        if (!append_piece(std::move(piece))) return false;
        piece = {};
    }
    return note_marks(std::move(fragment.behind));
}

// Counts the errors before and after the last radial separately, because later errors do not damage
// the volume.
void VolumeBuilder::count_errors(const Fragment& fragment) {
    if (fragment.pieces.empty()) {
        errors_behind_ += fragment.report.errors;
        return;
    }
    errors_within_ += errors_behind_ + fragment.report.errors - fragment.errors_behind;
    errors_behind_ = fragment.errors_behind;
}

Status VolumeBuilder::append(Fragment fragment) {
    switch (fragment.failure) {
        case Fragment::Failure::none:
        case Fragment::Failure::too_large_arrays:
            break;
        case Fragment::Failure::no_memory:
            return no_memory();
        case Fragment::Failure::too_much_output:
            return too_much_output();
    }
    if (Status counted = count_output(fragment.output_bytes); !counted) return counted;
    if (report_.ldm_records.value_or(0) + fragment.report.ldm_records.value_or(0) > most_records) {
        return fail(ErrorCode::unsupported, "has more than {} LDM records", most_records);
    }
    cut_ = cut_ || fragment.cut;
    note_volume_facts(fragment);
    count_errors(fragment);
    if (fragment.failure == Fragment::Failure::too_large_arrays || !append_all(fragment)) {
        if (!late_failure_) return pass_on(late_failure_);
        return fail(ErrorCode::unsupported, "its arrays take more than the limit of {} bytes",
                    array_limit_bytes_);
    }
    report().append(std::move(fragment.report));
    return {};
}

// Fails if nothing is whole. Sets the station, and calls check_volume() to find missing parts.
Result<Decoded> VolumeBuilder::finish(const std::string& fallback_station) {
    const bool last_is_newest = sweep_is_open_;
    end_sweep();
    if (is_disordered_) put_sweeps_in_order();
    const auto& counts = report_.message_counts;
    const bool anything = std::any_of(counts.begin(), counts.end(),
                                      [](const auto& count) { return count.first != 0; });
    if (!anything) {
        return fail(
            cut_ ? ErrorCode::truncated : ErrorCode::corrupt, "no part of it is intact: {}",
            report_.corruption ? report_.corruption->reason : "neither radials nor metadata");
    }
    volume_.station = station(fallback_station);
    if (!report_.message_station.empty() && volume_.station != report_.message_station) {
        report().add(Severity::note, "station_disagrees",
                     fmt::format("the radials name {}; the volume is that of its header, {}",
                                 report_.message_station, volume_.station));
    }
    const bool ended = volume_has_ended();
    report_late();
    const bool all_cuts = report_.sweeps_left_out == 0 && report_.records_skipped == 0;
    const VolumeFacts facts{
        previous_.has_value(), ended, all_cuts, last_is_newest, report_.further_volume_starts,
        report_.rda_status};
    const bool gaps = check_volume(volume_, facts, report());
    report_.damaged = incomplete_ || errors_within_ > 0;
    report_.complete = ended && !gaps && !report_.damaged;
    report().finish();
    return Decoded{std::move(volume_), std::move(report_)};
}

}  // namespace stormcellar::level2
