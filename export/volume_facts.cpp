#include "export/volume_facts.h"

#include <algorithm>
#include <chrono>
#include <cstddef>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/printable.h"

namespace stormcellar::netcdf {

Coverage coverage_of(std::span<const level2::Sweep> sweeps, UtcTime otherwise) {
    std::optional<UtcTime> first;
    std::optional<UtcTime> last;
    std::optional<UtcTime> before;
    Coverage coverage;
    for (const level2::Sweep& sweep : sweeps) {
        for (const level2::Radial& radial : sweep.radials) {
            if (before && radial.time < *before) coverage.times_increase = false;
            before = radial.time;
            if (!level2::is_plausible(radial.time)) continue;
            first = std::min(first.value_or(radial.time), radial.time);
            last = std::max(last.value_or(radial.time), radial.time);
        }
    }
    const UtcTime start = first.value_or(otherwise);
    coverage.start = std::chrono::floor<std::chrono::seconds>(start);
    coverage.end = std::chrono::ceil<std::chrono::seconds>(last.value_or(start));
    return coverage;
}

Coverage coverage_of(const level2::Volume& volume) {
    return coverage_of(volume.sweeps, volume.start_time().value_or(UtcTime{}));
}

std::string institution_of(const std::optional<Station>& station) {
    if (!station) return "unknown";
    return station->kind == RadarKind::tdwr ? "TDWR network of the FAA"
                                            : "NEXRAD network of NOAA, the U.S. Air Force and FAA";
}

float fixed_angle_deg(const level2::Sweep& sweep) {
    if (sweep.vcp_elevation_deg) return *sweep.vcp_elevation_deg;
    std::vector<float> elevations_deg;
    elevations_deg.reserve(sweep.radials.size());
    for (const level2::Radial& radial : sweep.radials)
        elevations_deg.push_back(radial.elevation_deg);
    const auto middle =
        elevations_deg.begin() + static_cast<std::ptrdiff_t>(elevations_deg.size() / 2);
    std::nth_element(elevations_deg.begin(), middle, elevations_deg.end());
    return *middle;
}

std::string text_of_notes(const std::vector<std::string>& notes) {
    std::vector<std::string> lines;
    for (const std::string& note : notes)
        lines.push_back(printable(note));
    return fmt::format("{}", fmt::join(lines, "\n"));
}

}  // namespace stormcellar::netcdf
