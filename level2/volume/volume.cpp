#include "stormcellar/level2/volume.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "stormcellar/base/station_table.h"

namespace stormcellar::level2 {
namespace {

// In sound volumes, the header and the radials differ by up to 10 s; they differ by more if the
// first records are lost.
constexpr std::chrono::hours header_tolerance{1};

constexpr double altitude_tolerance_m = 30;
constexpr double position_tolerance_deg = 0.01;
// If the radar sends a position within this distance of the station table, the sent latitude and
// longitude are used, because sites have moved by some kilometers. A position farther off is wrong.
constexpr double position_limit_deg = 1;

std::optional<AntennaPosition> position_of_block(const VolumeBlock& block) {
    double latitude_deg = block.latitude_deg;
    double longitude_deg = block.longitude_deg;
    if (!std::isfinite(latitude_deg) || !std::isfinite(longitude_deg)) return std::nullopt;
    // TDWR files of 2019 and 2020 give thousandths of a degree.
    if (std::abs(latitude_deg) > 90 || std::abs(longitude_deg) > 180) {
        latitude_deg /= 1000;
        longitude_deg /= 1000;
    }
    const bool usable = std::abs(latitude_deg) <= 90 && std::abs(longitude_deg) <= 180 &&
                        (latitude_deg != 0 || longitude_deg != 0);
    if (!usable) return std::nullopt;
    const int site_m = block.site_height_m;
    const int tower_m = block.tower_height_m;
    const double altitude_m = site_m == tower_m ? site_m : site_m + tower_m;
    return AntennaPosition{latitude_deg, longitude_deg, altitude_m, false, std::nullopt};
}

AntennaPosition position_of_station(const Station& station) {
    return {station.latitude_deg, station.longitude_deg, station.antenna_altitude_m, true,
            std::nullopt};
}

AntennaPosition reconcile(const AntennaPosition& radar, const Station& station) {
    double longitude_step = std::abs(radar.longitude_deg - station.longitude_deg);
    longitude_step = std::min(longitude_step, 360 - longitude_step);
    const double step_deg =
        std::max(std::abs(radar.latitude_deg - station.latitude_deg), longitude_step);
    const bool altitude_differs =
        std::abs(radar.altitude_m - station.antenna_altitude_m) > altitude_tolerance_m;
    AntennaPosition position = radar;
    if (step_deg > position_limit_deg) {
        position = position_of_station(station);
    } else if (altitude_differs && step_deg <= position_tolerance_deg) {
        // The site has not moved, so the altitude of the station table is right.
        position.altitude_m = station.antenna_altitude_m;
        position.from_table = true;
    }
    if (altitude_differs || step_deg > position_tolerance_deg) {
        position.disagreement = fmt::format(
            "{} says {:.4f}, {:.4f}, {:.0f} m; the station table {:.4f}, {:.4f}, {:.0f} m",
            station.icao, radar.latitude_deg, radar.longitude_deg, radar.altitude_m,
            station.latitude_deg, station.longitude_deg, station.antenna_altitude_m);
    }
    return position;
}

// Returns the median of the plausible times of the sweep's radials.
std::optional<UtcTime> middle_of(const Sweep& sweep) {
    std::vector<UtcTime> times;
    for (const Radial& radial : sweep.radials) {
        if (is_plausible(radial.time)) times.push_back(radial.time);
    }
    if (times.empty()) return std::nullopt;
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    return *middle;
}

// Returns the time of the first radial that is within an hour of the median of its sweep, because a
// single damaged radial may have any time.
std::optional<UtcTime> first_of(const std::vector<Sweep>& sweeps) {
    for (const Sweep& sweep : sweeps) {
        const auto middle = middle_of(sweep);
        if (!middle) continue;
        for (const Radial& radial : sweep.radials) {
            if (std::chrono::abs(radial.time - *middle) <= header_tolerance) return radial.time;
        }
    }
    return std::nullopt;
}

}  // namespace

GateStatus status_of_code(Moment moment, std::uint16_t code) {
    const MomentFacts& facts = facts_of(moment);
    if (code >= facts.first_valid_code) return GateStatus::valid;
    if (facts.is_derived && code == 2) return GateStatus::ambiguous;
    if (facts.first_valid_code > 2 && !facts.is_derived) return GateStatus::no_data;
    return code == 0 ? GateStatus::below_threshold : GateStatus::range_folded;
}

GateStatus SweepMoment::status(std::size_t radial, std::int32_t gate) const {
    if (radial >= gate_counts.size() || gate < 0 || gate >= gate_counts[radial]) {
        return GateStatus::no_data;
    }
    return status_of_code(moment, code(radial, gate));
}

const SweepMoment* Sweep::find(Moment moment) const {
    for (const SweepMoment& candidate : moments) {
        if (candidate.moment == moment) return &candidate;
    }
    return nullptr;
}

double Sweep::mean_elevation_deg() const {
    if (radials.empty()) return std::numeric_limits<double>::quiet_NaN();
    double sum = 0;
    for (const Radial& radial : radials)
        sum += radial.elevation_deg;
    return sum / static_cast<double>(radials.size());
}

std::optional<int> VolumeHeader::volume_number() const {
    const std::size_t dot = filename.rfind('.');
    if (dot == std::string::npos || dot + 1 == filename.size()) return std::nullopt;
    int number = 0;
    const char* end = filename.data() + filename.size();
    const auto [stopped, error] = std::from_chars(filename.data() + dot + 1, end, number);
    if (error != std::errc{} || stopped != end || number < 0 || number > 999) return std::nullopt;
    return number;
}

bool is_plausible(UtcTime time) {
    using namespace std::chrono;
    return UtcTime{} <= time && time < UtcTime{sys_days{year{2150} / 1 / 1}};
}

bool is_time_of_volume(UtcTime time, std::optional<UtcTime> start) {
    constexpr std::chrono::hours longest{6};
    return is_plausible(time) && (!start || std::chrono::abs(time - *start) <= longest);
}

RadialStatus status_of(const Radial& radial) {
    return static_cast<RadialStatus>(radial.status & 0x7FU);
}

bool has_ended(std::span<const Sweep> sweeps) {
    if (sweeps.empty() || sweeps.back().radials.empty()) return false;
    return status_of(sweeps.back().radials.back()) == RadialStatus::end_of_volume;
}

bool has_ended(const Volume& volume) {
    return has_ended(std::span<const Sweep>{volume.sweeps});
}

std::optional<UtcTime> Volume::start_time() const {
    const std::optional<UtcTime> first = first_of(sweeps);
    if (!header || !is_plausible(header->time())) return first;
    if (first && std::chrono::abs(header->time() - *first) > header_tolerance) return first;
    return header->time();
}

std::string volume_name(std::string_view station, UtcTime start) {
    return std::string{station} + format_compact(start);
}

std::size_t Volume::radial_count() const {
    std::size_t count = 0;
    for (const Sweep& sweep : sweeps)
        count += sweep.radials.size();
    return count;
}

std::optional<AntennaPosition> antenna_position(const Volume& volume) {
    const std::optional<Station> station = find_station(volume.station);
    std::optional<AntennaPosition> radar =
        volume.block ? position_of_block(*volume.block) : std::nullopt;
    if (radar && station) return reconcile(*radar, *station);
    if (radar) return radar;
    if (station) return position_of_station(*station);
    return std::nullopt;
}

}  // namespace stormcellar::level2
