#include "level2/volume_checks.h"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

// How many radials are missing.
int check_missing(const Volume& volume, const std::vector<RadialGaps>& gaps, ReportWriter& report) {
    int missing = 0;
    int sweeps = 0;
    int missing_elsewhere = 0;
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

bool check_radials(const Volume& volume, ReportWriter& report) {
    std::vector<RadialGaps> gaps;
    for (const Sweep& sweep : volume.sweeps)
        gaps.push_back(gaps_of(sweep));
    const int missing = check_missing(volume, gaps, report);
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        if (gaps[i].repeated == 0) continue;
        report.add(Severity::warning, "repeated_radials",
                   fmt::format("the radials' numbers go back inside sweep {} (elevation number {})",
                               i, volume.sweeps[i].elevation_number));
    }
    return missing > 0;
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

bool check_volume(const Volume& volume, bool has_radials, bool has_ended,
                  const std::optional<RdaStatus>& status, ReportWriter report) {
    const bool missing = check_radials(volume, report);
    check_position(volume, report);
    check_time(volume, report);
    if (!has_radials) {
        report.add(Severity::warning, "no_radials", "metadata without radials");
    } else if (!has_ended) {
        report.add(Severity::warning, "no_end_of_volume",
                   "the volume stops before its end: its last radial is not marked as the last");
    }
    if (!status) return missing;
    const std::vector<std::string> troubles = rda_troubles(*status);
    if (!troubles.empty()) {
        report.add(Severity::note, "radar_trouble",
                   fmt::format("the radar reports: {}", fmt::join(troubles, ", ")));
    }
    return missing;
}

}  // namespace stormcellar::level2
