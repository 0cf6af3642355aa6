#include "level2/decode/volume_checks.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "level2/decode/fragment_builder.h"

namespace stormcellar::level2 {
namespace {

using Sweeps = std::span<const Sweep>;

// more than the 720 of the ICD, and more than known test radars send
constexpr int greatest_azimuth_number = 1000;

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

// At most this many sweeps are listed one by one in a report.
constexpr int most_named_sweeps = 8;

// Reports sweeps that lost their last radials, and returns true if there are any. The last sweep
// does not count, because its missing end is reported as another problem. A sweep before a new pass
// of its cut does not count, because the radar gave it up.
bool check_ends(Sweeps all, bool last_is_newest, ReportWriter& report) {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool is_last = i + 1 == all.size();
        if (is_last && last_is_newest) break;
        const bool begins_again =
            !is_last && all[i].elevation_number == all[i + 1].elevation_number;
        if (!begins_again && !ends_sweep(all[i].radials.back())) open.push_back(i);
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

// Reports missing radials, and returns their number.
std::int64_t check_missing(Sweeps all, const std::vector<RadialGaps>& gaps, ReportWriter& report) {
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
                               all[i].elevation_number, gaps[i].missing,
                               gaps[i].missing == 1 ? "radial" : "radials", gaps[i].first_missing));
    }
    if (sweeps > most_named_sweeps) {
        report.add(Severity::warning, "missing_radials",
                   fmt::format("{} further sweeps lack {} radials", sweeps - most_named_sweeps,
                               missing_elsewhere));
    }
    return missing;
}

// Reports volumes that stop before their end although another volume follows. Returns true if there
// are any.
bool check_given_up(Sweeps all, const std::vector<std::size_t>& volume_starts,
                    ReportWriter& report) {
    std::vector<std::size_t> numbers;
    for (std::size_t i = 0; i < volume_starts.size(); ++i) {
        const std::size_t start = volume_starts[i];
        if (start == 0 || start > all.size()) continue;
        if (!has_ended(all.first(start))) numbers.push_back(i + 1);
    }
    if (numbers.empty()) return false;
    const std::size_t named = std::min(numbers.size(), std::size_t{most_named_sweeps});
    report.add(
        Severity::warning, "given_up",
        fmt::format("{} before the end, and another one begins: number {}{} of the file",
                    numbers.size() == 1 ? std::string{"a volume stops"}
                                        : fmt::format("{} volumes stop", numbers.size()),
                    fmt::join(numbers.begin(), numbers.begin() + static_cast<long>(named), ", "),
                    named < numbers.size() ? " ..." : ""));
    return true;
}

// Reports sweeps in which the time goes back by an hour or more from one radial to the next, so
// that one of the times must be wrong.
void check_clock(Sweeps all, ReportWriter& report) {
    constexpr std::chrono::hours most{1};
    std::size_t sweeps = 0;
    std::size_t first = 0;
    UtcTime::duration farthest{};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::vector<Radial>& radials = all[i].radials;
        UtcTime::duration back{};
        for (std::size_t k = 1; k < radials.size(); ++k)
            back = std::max(back, radials[k - 1].time - radials[k].time);
        if (back < most) continue;
        if (sweeps++ == 0) first = i;
        farthest = std::max(farthest, back);
    }
    if (sweeps == 0) return;
    const std::chrono::duration<double, std::ratio<3600>> hours = farthest;
    report.add(
        Severity::warning, "times_run_back",
        fmt::format("the radials' times run back by up to {:.1f} hours inside {}", hours.count(),
                    sweeps == 1 ? fmt::format("sweep {}", first)
                                : fmt::format("{} sweeps, first in sweep {}", sweeps, first)));
}

// Reports missing cuts, and returns true if there are any. In each volume, cuts must count upward
// from 1 by one; a volume may end at any cut.
bool check_cuts(Sweeps all, const std::vector<std::size_t>& volume_starts, ReportWriter& report) {
    int gaps = 0;
    int previous = 0;
    auto next_volume = volume_starts.begin();
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (next_volume != volume_starts.end() && *next_volume == i) {
            previous = 0;
            ++next_volume;
        }
        const int number = all[i].elevation_number;
        if (number > previous + 1 && ++gaps <= most_named_sweeps) {
            report.add(Severity::warning, "missing_cuts",
                       number == previous + 2
                           ? fmt::format("before sweep {}, cut {} is missing", i, previous + 1)
                           : fmt::format("before sweep {}, cuts {} to {} are missing", i,
                                         previous + 1, number - 1));
        }
        previous = number;
    }
    if (gaps > most_named_sweeps) {
        report.add(
            Severity::warning, "missing_cuts",
            fmt::format("before {} further sweeps, cuts are missing", gaps - most_named_sweeps));
    }
    return gaps > 0;
}

void check_repeated(Sweeps all, const std::vector<RadialGaps>& gaps, ReportWriter& report) {
    std::size_t sweeps = 0;
    std::size_t first = 0;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        if (gaps[i].repeated > 0 && sweeps++ == 0) first = i;
    }
    if (sweeps == 0) return;
    std::string where =
        fmt::format("sweep {} (elevation number {})", first, all[first].elevation_number);
    if (sweeps > 1) where = fmt::format("{} sweeps, first in {}", sweeps, where);
    report.add(Severity::warning, "repeated_radials",
               fmt::format("the radials' numbers go back inside {}", where));
}

// Reports azimuth numbers that no radar sends. They do not count as missing radials.
void check_numbers(Sweeps all, ReportWriter& report) {
    std::size_t odd = 0;
    for (const Sweep& sweep : all) {
        odd +=
            static_cast<std::size_t>(std::ranges::count_if(sweep.radials, [](const Radial& radial) {
                return radial.azimuth_number > greatest_azimuth_number;
            }));
    }
    if (odd == 0) return;
    report.add(Severity::note, "odd_numbers",
               fmt::format("{} {} a number above {}", odd, odd == 1 ? "radial has" : "radials have",
                           greatest_azimuth_number));
}

bool check_radials(Sweeps all, bool last_is_newest, ReportWriter& report) {
    std::vector<RadialGaps> gaps;
    for (const Sweep& sweep : all)
        gaps.push_back(gaps_of(sweep));
    const std::int64_t missing = check_missing(all, gaps, report);
    check_repeated(all, gaps, report);
    const bool ends_missing = check_ends(all, last_is_newest, report);
    return missing > 0 || ends_missing;
}

}  // namespace

RadialGaps gaps_of(const Sweep& sweep) {
    RadialGaps gaps;
    int due = 1;
    for (const Radial& radial : sweep.radials) {
        const int number = radial.azimuth_number;
        if (number == 0 || number > greatest_azimuth_number) continue;
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
    const bool missing_radials = check_radials(volume.sweeps, facts.last_sweep_is_newest, report);
    // If cuts were left out by the selection, gaps between cuts are no fault.
    const bool missing_cuts =
        facts.all_cuts && check_cuts(volume.sweeps, facts.volume_starts, report);
    const bool given_up =
        facts.all_cuts && check_given_up(volume.sweeps, facts.volume_starts, report);
    const bool missing = missing_radials || missing_cuts || given_up;
    check_clock(volume.sweeps, report);
    check_numbers(volume.sweeps, report);
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

bool is_complete(std::span<const Sweep> sweeps) {
    DecodeReport unused;
    ReportWriter report{unused};
    return has_ended(sweeps) && !check_radials(sweeps, true, report) &&
           !check_cuts(sweeps, {}, report);
}

bool is_complete(const Volume& volume) {
    return is_complete(volume.sweeps);
}

bool holds(const Volume& volume, Moment moment) {
    return std::ranges::any_of(volume.sweeps,
                               [&](const Sweep& sweep) { return sweep.find(moment) != nullptr; });
}

std::vector<VolumePart> volumes_in(const Decoded& decoded) {
    const std::vector<Sweep>& sweeps = decoded.volume.sweeps;
    std::vector<std::size_t> starts = {0};
    for (const std::size_t start : decoded.report.further_volume_starts) {
        if (start > starts.back() && start < sweeps.size()) starts.push_back(start);
    }
    std::vector<VolumePart> parts;
    for (std::size_t i = 0; i < starts.size(); ++i) {
        const std::size_t end = i + 1 < starts.size() ? starts[i + 1] : sweeps.size();
        const auto own = std::span{sweeps}.subspan(starts[i], end - starts[i]);
        parts.push_back({starts[i], own.size(), !decoded.report.damaged && is_complete(own)});
    }
    return parts;
}

}  // namespace stormcellar::level2
