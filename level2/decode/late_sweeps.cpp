// Defines the functions of VolumeBuilder that put late radials where they belong.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/memory.h"
#include "level2/decode/late_radials.h"
#include "level2/decode/sweep_rows.h"
#include "level2/decode/volume_builder.h"
#include "stormcellar/level2/live_sweep.h"

namespace stormcellar::level2 {
namespace {

// Limits for the bytes moved, and for the sweeps searched for one radial. The worst order of a real
// volume stays within them; a hostile file must not take more time.
constexpr std::uint64_t most_late_bytes = std::uint64_t{4} << 30;
constexpr std::size_t most_candidates = 8;

// Returns the most bytes that the arrays of `sweep` can take with the rows of `rows_of` inserted.
std::uint64_t bytes_with(const Sweep& sweep, const Sweep& rows_of) {
    const std::uint64_t radials = sweep.radials.size() + rows_of.radials.size();
    std::uint64_t bytes = empty_sweep_bytes + radials * sizeof(Radial);
    const auto add_kind = [&](const SweepMoment& moment, std::int32_t stride) {
        const auto codes = static_cast<std::uint64_t>(stride) * rows::bytes_per_code(moment);
        bytes += empty_kind_bytes + radials * (sizeof(std::uint16_t) + codes + codes / 4);
    };
    for (const SweepMoment& moment : sweep.moments) {
        std::int32_t stride = moment.gate_stride;
        for (const SweepMoment& more : rows_of.moments) {
            if (rows::same_kind(moment, more)) stride = std::max(stride, more.gate_stride);
        }
        add_kind(moment, stride);
    }
    for (const SweepMoment& more : rows_of.moments) {
        const bool is_there = std::ranges::any_of(sweep.moments, [&](const SweepMoment& moment) {
            return rows::same_kind(moment, more);
        });
        if (!is_there) add_kind(more, more.gate_stride);
    }
    return bytes;
}

}  // namespace

void VolumeBuilder::drop_sweep(std::size_t index) {
    Sweep& sweep = volume_.sweeps.at(index);
    free_array(sweep.radials);  // elevation number and message type stay, for find_late_place()
    free_array(sweep.moments);
}

void VolumeBuilder::put_back(std::size_t index, Sweep sweep) {
    if (volume_.sweeps.at(index).radials.empty()) volume_.sweeps[index] = std::move(sweep);
}

bool VolumeBuilder::header_is_repeated() const {
    const auto& further = report_.further_headers;
    const std::optional<VolumeHeader>& own =
        further.empty() ? volume_.header : std::optional{further.back().header};
    return own && own->filename == pending_header_->filename &&
           own->date == pending_header_->date && own->ms == pending_header_->ms;
}

Status VolumeBuilder::fetch_back(std::size_t index) {
    if (!volume_.sweeps[index].radials.empty()) return {};
    if (!dropped_) return fail(ErrorCode::internal, "a sweep that was dropped is missing");
    auto back = dropped_(index);
    if (!back) return pass_on(back);
    volume_.sweeps[index] = std::move(*back);
    touched_.fetched.insert(index);
    return {};
}

// Returns true if the radial may go into the same sweep as the late radials before it.
bool VolumeBuilder::may_follow_late(const Sweep& from, std::size_t radial) const {
    if (!late_place_ || pending_header_) return false;
    const Sweep& sweep = volume_.sweeps[late_place_->sweep];
    return sweep.elevation_number == from.elevation_number &&
           sweep.message_type == from.message_type && from.radials[radial].time <= previous_->time;
}

// Searches the sweeps of the newest volume, the newest first, for the place of a late radial, and
// sets late_place_. Returns true if it found one.
Result<bool> VolumeBuilder::find_late_place(const Sweep& from, std::size_t radial) {
    late_place_.reset();
    if (late_searches_ == most_late_searches || !is_late(from, radial)) return false;
    if (pending_header_ && !header_is_repeated()) return false;
    ++late_searches_;
    const auto& starts = report_.further_volume_starts;
    const std::size_t first = starts.empty() ? 0 : starts.back();
    std::size_t candidates = 0;
    for (std::size_t index = volume_.sweeps.size();
         index-- > first && candidates < most_candidates;) {
        const Sweep& sweep = volume_.sweeps[index];
        if (sweep.elevation_number != from.elevation_number ||
            sweep.message_type != from.message_type) {
            continue;
        }
        ++candidates;
        if (Status here = fetch_back(index); !here) return pass_on(here);
        const auto at = place_of_late(sweep, from.radials[radial]);
        if (!at) continue;
        late_place_ = LatePlace{index, *at};
        return true;
    }
    return false;
}

// Takes late radials as long as each fills a gap or repeats a present radial. Returns the index of
// the first radial that neither fills a gap nor repeats a radial.
Result<std::size_t> VolumeBuilder::take_late(Sweep& from, std::size_t first) {
    const std::size_t count = from.radials.size();
    std::size_t at = first;
    while (at < count && late_bytes_ <= most_late_bytes) {
        LateFit fit = LateFit::none;
        if (may_follow_late(from, at)) {
            if (Status here = fetch_back(late_place_->sweep); !here) return pass_on(here);
            fit = fit_of_late(from.radials[at], nullptr);
        }
        if (fit == LateFit::none) {
            const auto found = find_late_place(from, at);
            if (!found) return pass_on(found);
            if (!*found) break;
            fit = fit_of_late(from.radials[at], nullptr);
            pending_header_.reset();
        }
        if (fit == LateFit::repeats) {
            ++repeated_radials_;
            ++late_place_->at;
            ++at;
            continue;
        }
        const std::size_t begin = at++;
        while (at < count && may_follow_late(from, at) &&
               fit_of_late(from.radials[at], &from.radials[at - 1]) == LateFit::fills_gap) {
            ++at;
        }
        if (Status inserted = insert_late(from, begin, at); !inserted) return pass_on(inserted);
    }
    return at;
}

// Returns how a radial fits at late_place_. `before` is the previous late radial if it is not in
// the sweep yet; else null.
LateFit VolumeBuilder::fit_of_late(const Radial& radial, const Radial* before) const {
    const auto [index, at] = *late_place_;
    const Sweep& sweep = volume_.sweeps[index];
    if (before == nullptr && at > 0) before = &sweep.radials[at - 1];
    return fit_at(sweep, at, before, radial);
}

Status VolumeBuilder::insert_late(Sweep& from, std::size_t first, std::size_t end) {
    Sweep& sweep = volume_.sweeps[late_place_->sweep];
    const bool is_open = sweep_is_open_ && late_place_->sweep + 1 == volume_.sweeps.size();
    const Sweep part = rows::part_of(from, first, end);
    const std::uint64_t bytes = bytes_with(sweep, part);
    if (bytes > most_sweep_bytes || !room_.add(bytes - std::min(bytes, bytes_of(sweep)))) {
        return fail(ErrorCode::unsupported, "its arrays take more than the limit of {} bytes",
                    array_limit_bytes_);
    }
    late_bytes_ += bytes;
    append_rows(sweep, part);
    rows::move_last_rows(sweep, end - first, late_place_->at);
    if (!is_open) rows::make_whole(sweep);
    late_place_->at += end - first;
    late_radials_ += end - first;
    for (const Radial& radial : part.radials) {
        if (status_of(radial) == RadialStatus::start_of_volume) start_has_come_ = true;
    }
    if (!is_open) {
        touched_.fetched.erase(late_place_->sweep);
        touched_.changed.insert(late_place_->sweep);
    }
    return {};
}

// Sorts the sweeps of each volume by their times. Whole sweeps may come in the wrong order.
void VolumeBuilder::put_sweeps_in_order() {
    std::vector<std::size_t> starts = report_.further_volume_starts;
    starts.push_back(volume_.sweeps.size());
    std::size_t begin = 0;
    for (const std::size_t end : starts) {
        std::stable_sort(volume_.sweeps.begin() + static_cast<std::ptrdiff_t>(begin),
                         volume_.sweeps.begin() + static_cast<std::ptrdiff_t>(end),
                         [](const Sweep& a, const Sweep& b) {
                             return a.radials.front().time < b.radials.front().time;
                         });
        begin = end;
    }
}

void VolumeBuilder::report_late() {
    if (late_radials_ > 0) {
        report().add(Severity::note, "late_radials",
                     fmt::format("{} {} after newer ones and {} put where {}", late_radials_,
                                 late_radials_ == 1 ? "radial came" : "radials came",
                                 late_radials_ == 1 ? "was" : "were",
                                 late_radials_ == 1 ? "it belongs" : "they belong"));
    }
    if (repeated_radials_ > 0) {
        report().add(Severity::note, "radials_came_twice",
                     fmt::format("{} {} twice and {} taken once", repeated_radials_,
                                 repeated_radials_ == 1 ? "radial came" : "radials came",
                                 repeated_radials_ == 1 ? "was" : "were"));
    }
}

}  // namespace stormcellar::level2
