#include "level2/fragment_builder.h"

#include <algorithm>
#include <utility>

#include "base/station_table.h"
#include "level2/sweep_rows.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t most_rows = 720;  // to make room for

}  // namespace

bool begins_sweep(const Radial& radial) {
    const RadialStatus status = status_of(radial);
    return status == RadialStatus::start_of_elevation || status == RadialStatus::start_of_volume ||
           status == RadialStatus::start_of_last_elevation;
}

bool ends_sweep(const Radial& radial) {
    const RadialStatus status = status_of(radial);
    return status == RadialStatus::end_of_elevation || status == RadialStatus::end_of_volume;
}

bool FragmentBuilder::take_room(std::uint64_t bytes) {
    if (bytes > limit_bytes_ - taken_bytes_) return false;
    taken_bytes_ += bytes;
    return true;
}

bool FragmentBuilder::begins_piece(const RadialMessage& message) const {
    if (fragment_.pieces.empty() || marks_.header || begins_sweep(message.radial)) return true;
    const Sweep& sweep = fragment_.pieces.back().sweep;
    return sweep.elevation_number != message.elevation_number ||
           sweep.message_type != message.message_type;
}

void FragmentBuilder::begin_piece(const RadialMessage& message) {
    // Whole sweeps one behind the other: make room for the next at once.
    if (!fragment_.pieces.empty()) {
        const std::size_t newest = fragment_.pieces.back().sweep.radials.size();
        expected_rows_ = std::clamp(newest, expected_rows_, std::max(expected_rows_, most_rows));
    }
    Fragment::Piece& piece = fragment_.pieces.emplace_back();
    piece.before = std::exchange(marks_, {});
    piece.vcp = message.vcp.value_or(0);
    piece.left_out = !selection_.wants_cut(message.elevation_number);
    piece.sweep.elevation_number = message.elevation_number;
    piece.sweep.message_type = message.message_type;
    piece.sweep.azimuth_spacing_deg = message.azimuth_spacing_deg;
}

void FragmentBuilder::note_volume_facts(const RadialMessage& message) {
    if (fragment_.station.empty() && is_icao(message.icao)) fragment_.station = message.icao;
    if (!fragment_.block && !message.volume_block.empty()) {
        fragment_.block = read_volume_block(message.volume_block);
    }
    if (fragment_.vcp == 0) fragment_.vcp = message.vcp.value_or(0);
}

// Adds the row of the piece's newest radial. Its bytes are taken already where the kind was there.
bool FragmentBuilder::add_moment(Sweep& sweep, const MomentBlock& block) {
    const std::size_t count = sweep.radials.size();
    const auto same = [&](const SweepMoment& moment) { return rows::same_kind(moment, block); };
    auto moment = std::find_if(sweep.moments.begin(), sweep.moments.end(), same);
    if (moment == sweep.moments.end()) {
        sweep.moments.push_back(rows::empty_like(block));
        moment = sweep.moments.end() - 1;
        if (!take_room(count * rows::bytes_per_row(*moment))) return false;
    }
    if (block.gates > moment->gate_stride) {
        const std::int32_t stride = rows::grown_stride(*moment, block.gates);
        const auto more = static_cast<std::uint64_t>(stride - moment->gate_stride);
        if (!take_room(count * more * rows::bytes_per_code(*moment))) return false;
        rows::set_stride(*moment, stride);
    }
    rows::pad(*moment, count - 1);
    rows::append(*moment, block);
    return true;
}

bool FragmentBuilder::has_too_many_kinds(const Sweep& sweep, const RadialMessage& message) const {
    for (const MomentBlock& block : message.moments()) {
        if (!selection_.wants(block.moment)) continue;
        const auto same_moment = [&](const SweepMoment& m) { return m.moment == block.moment; };
        const auto same = [&](const SweepMoment& m) { return rows::same_kind(m, block); };
        const auto kinds = std::count_if(sweep.moments.begin(), sweep.moments.end(), same_moment);
        const bool known = std::any_of(sweep.moments.begin(), sweep.moments.end(), same);
        if (!known && kinds >= most_kinds_of_a_moment) return true;
    }
    return false;
}

void FragmentBuilder::make_room(Sweep& sweep) const {
    sweep.radials.reserve(expected_rows_);
    for (SweepMoment& moment : sweep.moments)
        rows::reserve(moment, expected_rows_);
}

FragmentBuilder::Added FragmentBuilder::add_rows(Sweep& sweep, const RadialMessage& message) {
    sweep.radials.push_back(message.radial);
    for (const MomentBlock& block : message.moments()) {
        if (selection_.wants(block.moment) && !add_moment(sweep, block)) return Added::full;
    }
    return Added::added;
}

FragmentBuilder::Added FragmentBuilder::add(const RadialMessage& message) {
    const bool begins = begins_piece(message);
    if (!begins && has_too_many_kinds(fragment_.pieces.back().sweep, message)) {
        return Added::refused;
    }
    const std::uint64_t bytes =
        begins ? sizeof(Fragment::Piece) : rows::bytes_per_row(fragment_.pieces.back().sweep);
    if (!take_room(sizeof(Radial) + bytes)) return Added::full;
    if (begins) begin_piece(message);
    note_volume_facts(message);
    Fragment::Piece& piece = fragment_.pieces.back();
    if (!piece.left_out) {
        // Room is made with the second radial: a piece of one stays small.
        if (piece.sweep.radials.size() == 1) make_room(piece.sweep);
        return add_rows(piece.sweep, message);
    }
    if (piece.sweep.radials.size() == 2) piece.sweep.radials.pop_back();
    piece.sweep.radials.push_back(message.radial);
    return Added::added;
}

Fragment FragmentBuilder::take() {
    Fragment fragment = std::exchange(fragment_, {});
    fragment.behind = std::exchange(marks_, {});
    fragment.array_bytes = std::exchange(taken_bytes_, 0);
    return fragment;
}

}  // namespace stormcellar::level2
