#include "synth/scene.h"

#include <cmath>

#include "base/file_system.h"
#include "base/station_table.h"
#include "synth/toml_reader.h"

namespace stormcellar::synth {
namespace {

// No value of a scene is beyond these.
constexpr Range places_km{-1000, 1000};
constexpr Range lengths_km{0.05, 1000};
constexpr Range heights_km{0, 30};
constexpr Range speeds_mps{-200, 200};
constexpr Range peaks_dbz{edge_dbz + 1, 90};
constexpr Range directions_deg{-360, 360};
constexpr double km = 1000;

Site read_site(TomlReader& root) {
    Site site;
    auto radar = root.table("radar", true);
    if (!radar) return site;
    site.station = radar->text("station");
    if (!site.station.empty() && !is_icao(site.station)) {
        radar->refuse("station", "not four letters and digits, as in KTLX");
    }
    const auto known = find_station(site.station);
    const auto otherwise = [&](double Station::*field) {
        return known ? std::optional{(*known).*field} : std::nullopt;
    };
    site.latitude_deg = radar->number("latitude_deg", {-90, 90}, otherwise(&Station::latitude_deg));
    site.longitude_deg =
        radar->number("longitude_deg", {-180, 180}, otherwise(&Station::longitude_deg));
    const double altitude_m =
        radar->number("altitude_m", {-400, 9000}, otherwise(&Station::antenna_altitude_m));
    site.antenna_altitude_m = static_cast<int>(std::lround(altitude_m));
    radar->finish();
    return site;
}

Cut read_cut(TomlReader& table) {
    Cut cut;
    cut.elevation_deg = nearest_elevation_deg(table.number("elevation_deg", {-1, 60}));
    const std::string waveform = table.text("waveform", "batch");
    if (waveform == "surveillance") {
        cut.waveform = Waveform::surveillance;
    } else if (waveform == "doppler") {
        cut.waveform = Waveform::doppler;
    } else if (waveform == "batch") {
        cut.waveform = Waveform::batch;
    } else {
        table.refuse("waveform", "not surveillance, doppler or batch");
    }
    cut.azimuth_rate_deg_s = nearest_rate_deg_s(table.number("azimuth_rate_deg_s", {1, 40}));
    const double spacing_deg = table.number("azimuth_spacing_deg", {0.5, 1}, 1);
    if (spacing_deg != 0.5 && spacing_deg != 1) {
        table.refuse("azimuth_spacing_deg", "not 0.5 or 1");
    }
    cut.azimuth_spacing_deg = static_cast<float>(spacing_deg);
    cut.surveillance_prf = cut.waveform == Waveform::doppler ? 0 : 1;
    cut.doppler_prf = table.integer("doppler_prf", {4, 8}, 6);
    if (!has_velocity(cut)) cut.doppler_prf = 0;
    table.finish();
    return cut;
}

Pattern read_pattern(TomlReader& volumes, TomlReader& root) {
    auto cuts = root.tables("cut");
    if (cuts.empty()) {
        const int number = volumes.integer("vcp", {1, 999});
        const Pattern* known = find_pattern(number);
        if (known != nullptr) return *known;
        volumes.refuse("vcp", fmt::format("{} is not one of {}; other patterns need [[cut]] tables",
                                          number, fmt::join(pattern_numbers(), ", ")));
        return {};
    }
    Pattern pattern;
    pattern.number = volumes.integer("vcp", {1, 767}, 767);
    if (cuts.size() > 32) root.refuse("cut", "more than 32 cuts");
    for (TomlReader& cut : cuts) {
        pattern.cuts.push_back(read_cut(cut));
    }
    return pattern;
}

Schedule read_schedule(TomlReader& root) {
    Schedule schedule;
    auto volumes = root.table("volumes", true);
    if (!volumes) return schedule;
    schedule.count = volumes->integer("count", {1, 10000});
    const std::string start = volumes->text("start");
    // "now" and relative times would make a scene differ from run to run.
    const bool fixed = !start.empty() && start.front() >= '0' && start.front() <= '9';
    const auto time = fixed ? parse_utc(start, UtcTime{}) : Result<UtcTime>(UtcTime{});
    if (!fixed || !time) volumes->refuse("start", "not a time, as in \"2024-06-01T22:00:00Z\"");
    if (time) schedule.start = *time;
    schedule.pattern = read_pattern(*volumes, root);
    const double needed_s = duration_s(schedule.pattern);
    schedule.interval_s = volumes->number("interval_s", {1, 86400}, 300);
    if (schedule.interval_s < needed_s) {
        volumes->refuse("interval_s", fmt::format("{} s is shorter than the {:.0f} s that VCP {} "
                                                  "takes",
                                                  schedule.interval_s, std::ceil(needed_s),
                                                  schedule.pattern.number));
    }
    volumes->finish();
    return schedule;
}

Footprint read_footprint(TomlReader& table) {
    Footprint footprint;
    const auto [east_km, north_km] = table.pair("position_km", places_km);
    const auto [east_mps, north_mps] = table.pair("velocity_mps", speeds_mps, std::pair{0.0, 0.0});
    const auto [major_km, minor_km] = table.pair("radii_km", lengths_km);
    footprint.x_m = east_km * km;
    footprint.y_m = north_km * km;
    footprint.motion = {east_mps, north_mps};
    footprint.major_m = major_km * km;
    footprint.minor_m = minor_km * km;
    footprint.orientation_deg = table.number("orientation_deg", directions_deg, 0);
    return footprint;
}

Ripple read_ripple(TomlReader& table) {
    Ripple ripple;
    ripple.most_db = table.number("ripple_db", {0, 20}, 0);
    ripple.length_m = table.number("ripple_length_km", lengths_km, 5) * km;
    return ripple;
}

Hook read_hook(TomlReader& table) {
    Hook hook;
    const auto [east_km, north_km] = table.pair("center_km", {-100, 100});
    hook.x_m = east_km * km;
    hook.y_m = north_km * km;
    hook.radius_m = table.number("radius_km", {0.1, 100}) * km;
    const auto [from_deg, to_deg] = table.pair("arc_deg", {-360, 720});
    if (to_deg <= from_deg || to_deg - from_deg >= 360) {
        table.refuse("arc_deg", "not [from, to], clockwise and less than a full circle");
    }
    hook.from_deg = from_deg;
    hook.to_deg = to_deg;
    hook.width_m = table.number("width_km", lengths_km) * km;
    hook.top_m = table.number("top_km", {0.1, 30}) * km;
    hook.peak_dbz = table.number("peak_dbz", peaks_dbz);
    table.finish();
    return hook;
}

Storm read_storm(TomlReader& table) {
    Storm storm;
    storm.footprint = read_footprint(table);
    storm.core_m = table.number("core_km", heights_km) * km;
    storm.top_m = table.number("top_km", heights_km) * km;
    if (storm.top_m <= storm.core_m) table.refuse("top_km", "not above core_km");
    storm.peak_dbz = table.number("peak_dbz", peaks_dbz);
    const auto [east, north] = table.pair("tilt", {-10, 10}, std::pair{0.0, 0.0});
    storm.tilt_east = east;
    storm.tilt_north = north;
    storm.ripple = read_ripple(table);
    if (auto hook = table.table("hook", false)) storm.hook = read_hook(*hook);
    table.finish();
    return storm;
}

Layer read_layer(TomlReader& table) {
    Layer layer;
    layer.footprint = read_footprint(table);
    layer.base_m = table.number("base_km", heights_km, 0) * km;
    layer.top_m = table.number("top_km", heights_km) * km;
    if (layer.top_m <= layer.base_m) table.refuse("top_km", "not above base_km");
    layer.peak_dbz = table.number("peak_dbz", peaks_dbz);
    layer.melting_m = table.number("melting_km", heights_km, 3.5) * km;
    layer.bright_band_db = table.number("bright_band_db", {0, 30}, 0);
    layer.bright_band_depth_m = table.number("bright_band_depth_km", {0.05, 5}, 0.3) * km;
    layer.lapse_db_per_m = table.number("lapse_db_per_km", {0, 50}, 3) / km;
    layer.ripple = read_ripple(table);
    table.finish();
    return layer;
}

Result<toml::table> parse(std::string_view toml, const std::string& name) {
    try {
        return toml::parse(toml, name);
    } catch (const toml::parse_error& error) {
        const auto& begin = error.source().begin;
        return fail(ErrorCode::bad_argument, "{}:{}: {}", name, begin.line, error.description());
    }
}

}  // namespace

UtcTime Schedule::start_of(int volume) const {
    return start + std::chrono::milliseconds(std::llround(1000 * interval_s * volume));
}

Result<Scene> parse_scene(std::string_view toml, const std::string& name) {
    const auto document = parse(toml, name);
    if (!document) return pass_on(document);
    TomlErrors errors(name);
    TomlReader root(*document, "", errors);
    Scene scene;
    scene.site = read_site(root);
    scene.schedule = read_schedule(root);
    for (TomlReader& table : root.tables("storm")) {
        scene.weather.storms.push_back(read_storm(table));
    }
    for (TomlReader& table : root.tables("layer")) {
        scene.weather.layers.push_back(read_layer(table));
    }
    root.finish();
    if (errors.first()) return tl::unexpected(*errors.first());
    return scene;
}

Result<Scene> read_scene(const std::filesystem::path& path) {
    const auto bytes = read_file(path, 1U << 20U);
    if (!bytes) return pass_on(bytes);
    return parse_scene({reinterpret_cast<const char*>(bytes->data()), bytes->size()},
                       path.string());
}

}  // namespace stormcellar::synth
