#include "cli/velocity/cyclone_text.h"

#include <cmath>
#include <string_view>

#include "cli/shared/commands.h"
#include "cli/shared/query_options.h"

namespace stormcellar::cli {
namespace {

using nlohmann::ordered_json;
using retrieve::Cyclone;
using retrieve::CycloneRing;
using retrieve::Estimate;
using retrieve::NoCycloneReason;

constexpr double meters_per_km = 1000;
constexpr int row_step_km = 5;

std::string text_of(Estimate estimate) {
    return fmt::format("{:.1f} +- {:.1f}", estimate.value, estimate.error);
}

std::string head(const StationCyclone& found) {
    const Cyclone& cyclone = found.cyclone;
    const CycloneRing& top = cyclone.maximum();
    std::string text = fmt::format("{}  {}\n", found.station.empty() ? "unknown" : found.station,
                                   found.time ? format_utc(*found.time) : "unknown time");
    text += fmt::format("  center    {:.3f}, {:.3f} +- {:.1f} km, {:.0f} km from the radar\n",
                        cyclone.center.latitude_deg, cyclone.center.longitude_deg,
                        cyclone.center_error_m / meters_per_km, cyclone.distance_m / meters_per_km);
    text += fmt::format("  height    {:.1f} km above sea level, elevation {:.2f} degrees\n",
                        (found.antenna_altitude_m + cyclone.height_m) / meters_per_km,
                        cyclone.elevation_deg);
    text += fmt::format("  maximum   {} m/s, {:.0f} km from the center\n",
                        text_of(top.tangential_mps), top.radius_m / meters_per_km);
    text += fmt::format("  mean wind {} m/s along the beam, {} m/s to its left\n",
                        text_of(cyclone.along_mps), text_of(cyclone.across_mps));
    text += fmt::format("  pressure  {} hPa lower than {:.0f} km from the center\n",
                        text_of(cyclone.pressure_deficit_hpa),
                        cyclone.rings.back().radius_m / meters_per_km);
    if (cyclone.refolded_share > 0) {
        text += fmt::format("  refolded  {:.2f} % of the velocities, to fit the wind\n",
                            100 * cyclone.refolded_share);
    }
    return text;
}

ordered_json estimate_json(Estimate estimate) {
    return {{"value", estimate.value}, {"error", estimate.error}};
}

ordered_json ring_json(const CycloneRing& ring) {
    return {{"radius_m", ring.radius_m},
            {"tangential_mps", estimate_json(ring.tangential_mps)},
            {"across_error_mps", ring.across_error_mps},
            {"radial_mps", estimate_json(ring.radial_mps)},
            {"wave1_mps", ring.wave1_mps},
            {"waves", ring.waves},
            {"coverage", ring.coverage},
            {"largest_gap_deg", ring.largest_gap_deg}};
}

std::string_view name_of(NoCycloneReason reason) {
    switch (reason) {
        case NoCycloneReason::no_velocities:
            return "no_velocities";
        case NoCycloneReason::no_nyquist:
            return "no_nyquist";
        case NoCycloneReason::no_position:
            return "no_position";
        case NoCycloneReason::out_of_reach:
            return "out_of_reach";
        case NoCycloneReason::too_few_velocities:
            return "too_few_velocities";
        case NoCycloneReason::no_vortex:
            return "no_vortex";
        case NoCycloneReason::radar_inside:
            return "radar_inside";
        case NoCycloneReason::no_maximum:
            return "no_maximum";
    }
    return "unknown";
}

}  // namespace

std::string cyclone_table(const StationCyclone& found) {
    const Cyclone& cyclone = found.cyclone;
    std::string text = head(found);
    text += fmt::format("\n{:>6} {:>14} {:>14} {:>6} {:>8} {:>4}\n", "radius", "tangential",
                        "radial", "wave 1", "coverage", "gap");
    text += fmt::format("{:>6} {:>14} {:>14} {:>6} {:>8} {:>4}\n", "km", "m/s", "m/s", "m/s", "%",
                        "deg");
    for (const CycloneRing& ring : cyclone.rings) {
        const bool is_maximum = &ring == &cyclone.maximum();
        const auto radius_km = std::lround(ring.radius_m / meters_per_km);
        if (!is_maximum && radius_km % row_step_km != 0) continue;
        text +=
            fmt::format("{:>6} {:>14} {:>14} {:>6.1f} {:>8.0f} {:>4.0f}{}\n", radius_km,
                        text_of(ring.tangential_mps), text_of(ring.radial_mps), ring.wave1_mps,
                        100 * ring.coverage, ring.largest_gap_deg, is_maximum ? "  maximum" : "");
    }
    return text;
}

ordered_json cyclone_json(const StationCyclone& found) {
    const Cyclone& cyclone = found.cyclone;
    ordered_json json = {{"station", found.station},
                         {"time", json_time(found.time)},
                         {"center",
                          {{"latitude_deg", cyclone.center.latitude_deg},
                           {"longitude_deg", cyclone.center.longitude_deg},
                           {"error_m", cyclone.center_error_m}}},
                         {"distance_m", cyclone.distance_m},
                         {"sweep", cyclone.sweep},
                         {"elevation_deg", cyclone.elevation_deg},
                         {"height_m", found.antenna_altitude_m + cyclone.height_m},
                         {"maximum", ring_json(cyclone.maximum())},
                         {"mean_wind_along_mps", estimate_json(cyclone.along_mps)},
                         {"mean_wind_across_mps", estimate_json(cyclone.across_mps)},
                         {"pressure_deficit_hpa", estimate_json(cyclone.pressure_deficit_hpa)},
                         {"refolded_share", cyclone.refolded_share},
                         {"rings", ordered_json::array()}};
    for (const CycloneRing& ring : cyclone.rings)
        json["rings"].push_back(ring_json(ring));
    return json;
}

ordered_json no_cyclone_json(const retrieve::NoCyclone& none) {
    return {{"reason", name_of(none.reason)}, {"message", none.text}};
}

}  // namespace stormcellar::cli
