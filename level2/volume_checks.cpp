#include "level2/volume_checks.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "level2/fragment_builder.h"

namespace stormcellar::level2 {
namespace {

void check_position(const Volume& volume, ReportWriter& report) {
    const auto antenna = antenna_position(volume);
    if (!antenna) {
        report.add(Severity::warning, "no_position",
                   "neither the file nor the station table says where the radar stands");
    } else if (antenna->disagreement) {
        report.add(Severity::warning, "position_disagrees", *antenna->disagreement);
    }
}

void check_time(const Volume& volume, ReportWriter& report) {
    const auto start = volume.start_time();
    if (!volume.header || start == volume.header->time()) return;
    report.add(Severity::warning, "header_time",
               fmt::format("the volume header's date, day {} of the radar's calendar, is {}",
                           volume.header->date,
                           start ? "not that of the radials: theirs is taken"
                                 : "impossible, and no radial has a better one"));
}

// Sweeps that lack radials are named one by one as far as a person reads on.
constexpr int most_named_sweeps = 8;

// Sweeps whose last radials are lost, but for the last sweep, which has a problem of its own.
// A cut that begins again was given up by the radar.
bool check_ends(const Volume& volume, bool last_is_newest, ReportWriter& report) {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < volume.sweeps.size(); ++i) {
        const bool is_last = i + 1 == volume.sweeps.size();
        if (is_last && last_is_newest) break;
        const bool begins_again =
            !is_last && volume.sweeps[i].elevation_number == volume.sweeps[i + 1].elevation_number;
        if (!begins_again && !ends_sweep(volume.sweeps[i].radials.back())) open.push_back(i);
    }
    if (open.empty()) return false;
    const std::size_t named = std::min<std::size_t>(open.size(), most_named_sweeps);
    report.add(Severity::warning, "unended_sweeps",
               fmt::format("{} without a last radial: {}{}",
                           open.size() == 1 ? "a sweep" : fmt::format("{} sweeps", open.size()),
                           fmt::join(open.begin(), open.begin() + static_cast<long>(named), ", "),
                           named < open.size() ? " ..." : ""));
    return true;
}

// How many radials are missing.
std::int64_t check_missing(const Volume& volume, const std::vector<RadialGaps>& gaps,
                           ReportWriter& report) {
    std::int64_t missing = 0;
    int sweeps = 0;
    std::int64_t missing_elsewhere = 0;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        if (gaps[i].missing == 0) continue;
        missing += gaps[i].missing;
        if (++sweeps > most_named_sweeps) {
            missing_elsewhere += gaps[i].missing;
            continue;
        }
        report.add(Severity::warning, "missing_radials",
                   fmt::format("sweep {} (elevation number {}) lacks {} {}, from number {} on", i,
                               volume.sweeps[i].elevation_number, gaps[i].missing,
                               gaps[i].missing == 1 ? "radial" : "radials", gaps[i].first_missing));
    }
    if (sweeps > most_named_sweeps) {
        report.add(Severity::warning, "missing_radials",
                   fmt::format("{} further sweeps lack {} radials", sweeps - most_named_sweeps,
                               missing_elsewhere));
    }
    return missing;
}

// Cuts are numbered from 1 and count upwards by one; a volume may end at any of them.
bool check_cuts(const Volume& volume, const std::vector<std::size_t>& volume_starts,
                ReportWriter& report) {
    bool missing = false;
    int previous = 0;
    auto next_volume = volume_starts.begin();
    for (std::size_t i = 0; i < volume.sweeps.size(); ++i) {
        if (next_volume != volume_starts.end() && *next_volume == i) {
            previous = 0;
            ++next_volume;
        }
        const int number = volume.sweeps[i].elevation_number;
        if (number > previous + 1) {
            missing = true;
            report.add(Severity::warning, "missing_cuts",
                       number == previous + 2
                           ? fmt::format("before sweep {}, cut {} is missing", i, previous + 1)
                           : fmt::format("before sweep {}, cuts {} to {} are missing", i,
                                         previous + 1, number - 1));
        }
        previous = number;
    }
    return missing;
}

bool check_radials(const Volume& volume, bool last_is_newest, ReportWriter& report) {
    std::vector<RadialGaps> gaps;
    for (const Sweep& sweep : volume.sweeps)
        gaps.push_back(gaps_of(sweep));
    const std::int64_t missing = check_missing(volume, gaps, report);
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        if (gaps[i].repeated == 0) continue;
        report.add(Severity::warning, "repeated_radials",
                   fmt::format("the radials' numbers go back inside sweep {} (elevation number {})",
                               i, volume.sweeps[i].elevation_number));
    }
    const bool ends_missing = check_ends(volume, last_is_newest, report);
    return missing > 0 || ends_missing;
}

}  // namespace

RadialGaps gaps_of(const Sweep& sweep) {
    RadialGaps gaps;
    int due = 1;
    for (const Radial& radial : sweep.radials) {
        const int number = radial.azimuth_number;
        if (number == 0) continue;
        if (number > due) {
            if (gaps.missing == 0) gaps.first_missing = due;
            gaps.missing += number - due;
        } else if (number < due) {
            ++gaps.repeated;
        }
        due = number + 1;
    }
    return gaps;
}

bool check_volume(const Volume& volume, const VolumeFacts& facts, ReportWriter report) {
    const bool missing_radials = check_radials(volume, facts.last_sweep_is_newest, report);
    // Where only some cuts were asked for, others are bound to be missing.
    const bool missing_cuts = facts.all_cuts && check_cuts(volume, facts.volume_starts, report);
    const bool missing = missing_radials || missing_cuts;
    check_position(volume, report);
    check_time(volume, report);
    if (!facts.has_radials) {
        report.add(Severity::warning, "no_radials", "metadata without radials");
    } else if (!facts.has_ended) {
        report.add(Severity::warning, "no_end_of_volume",
                   "the volume stops before its end: its last radial is not marked as the last");
    }
    if (!facts.status) return missing;
    const std::vector<std::string> troubles = rda_troubles(*facts.status);
    if (!troubles.empty()) {
        report.add(Severity::note, "radar_trouble",
                   fmt::format("the radar reports: {}", fmt::join(troubles, ", ")));
    }
    return missing;
}

bool is_complete(const Volume& volume) {
    DecodeReport unused;
    ReportWriter report{unused};
    return has_ended(volume) && !check_radials(volume, true, report) &&
           !check_cuts(volume, {}, report);
}

}  // namespace stormcellar::level2
