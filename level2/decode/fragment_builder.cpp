#include "level2/decode/fragment_builder.h"

#include <algorithm>
#include <utility>

#include "level2/decode/sweep_rows.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t most_rows = 720;  // room is made for at most this many rows

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

bool FragmentBuilder::add_pattern(Vcp vcp) {
    if (!room_.add(bytes_of(vcp))) return false;
    marks_.patterns.push_back(std::move(vcp));
    return true;
}

bool FragmentBuilder::add_expanded(std::uint64_t bytes) {
    fragment_.output_bytes += bytes;
    return fragment_.output_bytes <= most_expanded_bytes;
}

// Returns true if the radial does not continue the newest piece.
bool FragmentBuilder::begins_sweep_here(const RadialMessage& message) const {
    if (marks_.header || begins_sweep(message.radial)) return true;
    const Sweep& sweep = fragment_.pieces.back().sweep;
    return sweep.elevation_number != message.elevation_number ||
           sweep.message_type != message.message_type;
}

bool FragmentBuilder::begin_piece(const RadialMessage& message) {
    // A fragment with several pieces may hold whole sweeps, so make room for as many rows as the
    // previous piece had.
    if (!fragment_.pieces.empty()) {
        const std::size_t newest = fragment_.pieces.back().sweep.radials.size();
        expected_rows_ = std::clamp(newest, expected_rows_, std::max(expected_rows_, most_rows));
    }
    // The first piece may continue a sweep of the previous fragment.
    bool has_room = true;
    if (fragment_.pieces.empty()) {
        room_.continue_sweep();
    } else {
        has_room = room_.begin_sweep();
    }
    Fragment::Piece& piece = fragment_.pieces.emplace_back();
    piece.before = std::exchange(marks_, {});
    piece.vcp = message.vcp.value_or(0);
    piece.left_out = !selection_.wants_cut(message.elevation_number);
    piece.sweep.elevation_number = message.elevation_number;
    piece.sweep.message_type = message.message_type;
    piece.sweep.azimuth_spacing_deg = message.azimuth_spacing_deg;
    return has_room;
}

void FragmentBuilder::note_volume_facts(const RadialMessage& message) {
    if (fragment_.station.empty()) fragment_.station = icao_of(message.icao).value_or("");
    if (!fragment_.block && !message.volume_block.empty()) {
        fragment_.block = read_volume_block(message.volume_block);
    }
    if (fragment_.vcp == 0) fragment_.vcp = message.vcp.value_or(0);
}

// Adds a row to a moment, for the newest radial of the piece.
bool FragmentBuilder::add_moment(Sweep& sweep, const MomentBlock& block) {
    const std::size_t count = sweep.radials.size();
    const auto same = [&](const SweepMoment& moment) { return rows::same_kind(moment, block); };
    auto moment = std::find_if(sweep.moments.begin(), sweep.moments.end(), same);
    const auto number = static_cast<std::size_t>(moment - sweep.moments.begin());
    if (!room_.widen(number, block.gates, block.word_size_bits == 8 ? 1 : 2)) return false;
    if (moment == sweep.moments.end()) {
        sweep.moments.push_back(rows::empty_like(block));
        moment = sweep.moments.end() - 1;
    }
    if (block.gates > moment->gate_stride) {
        rows::set_stride(*moment, rows::grown_stride(*moment, block.gates));
    }
    rows::pad(*moment, count - 1);
    rows::append(*moment, block);
    return true;
}

void FragmentBuilder::reserve_rows(Sweep& sweep) const {
    sweep.radials.reserve(expected_rows_);
    for (SweepMoment& moment : sweep.moments)
        rows::reserve(moment, expected_rows_);
}

bool FragmentBuilder::add_rows(Sweep& sweep, const RadialMessage& message) {
    if (!room_.add_radials(1)) return false;
    sweep.radials.push_back(message.radial);
    for (const MomentBlock& block : message.moments()) {
        if (selection_.wants(block.moment) && !add_moment(sweep, block)) return false;
    }
    return true;
}

bool FragmentBuilder::add(const RadialMessage& message) {
    errors_at_last_radial_ = fragment_.report.errors;
    const bool begins = fragment_.pieces.empty() || begins_sweep_here(message);
    if (begins && !begin_piece(message)) return false;
    note_volume_facts(message);
    Fragment::Piece& piece = fragment_.pieces.back();
    if (!piece.left_out) {
        // Make room at the second radial, so that a piece of one radial stays small.
        if (piece.sweep.radials.size() == 1) reserve_rows(piece.sweep);
        return add_rows(piece.sweep, message);
    }
    if (piece.sweep.radials.size() == 2) piece.sweep.radials.pop_back();
    piece.sweep.radials.push_back(message.radial);
    return true;
}

Fragment FragmentBuilder::take() {
    Fragment fragment = std::exchange(fragment_, {});
    fragment.behind = std::exchange(marks_, {});
    fragment.errors_behind =
        fragment.report.errors - std::exchange(errors_at_last_radial_, std::uint64_t{0});
    fragment.array_bytes = room_.taken_bytes();
    room_.clear();
    return fragment;
}

}  // namespace stormcellar::level2
