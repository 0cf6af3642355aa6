#include "synth/synth_scene.h"

#include <cmath>

#include "base/toml_file.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/site_frame.h"
#include "synth/read_instrument.h"

namespace stormcellar::synth {
namespace {

// The limits of the values of a scene.
constexpr TomlRange places_km{-1000, 1000};
constexpr TomlRange lengths_km{0.05, 1000};
constexpr TomlRange heights_km{0, 30};
constexpr TomlRange speeds_mps{-200, 200};
constexpr TomlRange peaks_dbz{edge_dbz + 1, 90};
constexpr double km = 1000;

constexpr TomlRange nyquists_mps{2, 63};  // 8-bit velocities end at 63 m/s

// Reads a required key. If it is missing or wrong, notes a complaint and returns the least value.
double needed_number(TomlTable& table, std::string_view key, TomlRange range) {
    if (!table.has(key)) table.complain(key, "is missing");
    return table.number(key, range).value_or(range.least);
}

int needed_whole_number(TomlTable& table, std::string_view key, TomlRange range) {
    if (!table.has(key)) table.complain(key, "is missing");
    return table.whole_number(key, range).value_or(static_cast<int>(range.least));
}

std::string needed_text(TomlTable& table, std::string_view key) {
    if (!table.has(key)) table.complain(key, "is missing");
    return table.text(key).value_or("");
}

struct Pair {
    double first = 0;
    double second = 0;
};

// Reads two numbers: [east, north].
Pair pair_or(TomlTable& table, std::string_view key, TomlRange range, Pair otherwise) {
    const auto numbers = table.numbers(key);
    if (!numbers) return otherwise;
    if (numbers->size() != 2) {
        table.complain(key, "must be two numbers, as in [east, north]");
        return otherwise;
    }
    for (const double number : *numbers) {
        if (number >= range.least && number <= range.most) continue;
        table.complain(key, fmt::format("{} is out of range, must be {} to {}", number, range.least,
                                        range.most));
        return otherwise;
    }
    return {(*numbers)[0], (*numbers)[1]};
}

Pair needed_pair(TomlTable& table, std::string_view key, TomlRange range) {
    if (!table.has(key)) table.complain(key, "is missing");
    return pair_or(table, key, range, {range.least, range.least});
}

Site read_site(TomlTable radar) {
    Site site;
    site.station = needed_text(radar, "station");
    const bool named = is_icao(site.station);
    if (!named && !site.station.empty()) {
        radar.complain("station", "must be four letters and digits, as in KTLX");
    }
    const auto known = find_station(site.station);
    const auto read = [&](std::string_view key, TomlRange range, double Station::*field) {
        if (known) return radar.number(key, range).value_or((*known).*field);
        // If the name is wrong, do not also complain that the position is missing.
        return named ? needed_number(radar, key, range) : radar.number(key, range).value_or(0);
    };
    site.latitude_deg = read("latitude_deg", {-90, 90}, &Station::latitude_deg);
    site.longitude_deg = read("longitude_deg", {-180, 180}, &Station::longitude_deg);
    const double altitude_m = read("altitude_m", {-400, 9000}, &Station::antenna_altitude_m);
    site.antenna_altitude_m = static_cast<int>(std::lround(altitude_m));
    return site;
}

Waveform read_waveform(TomlTable& cut) {
    const std::string name = cut.text("waveform").value_or("batch");
    if (name == "surveillance") return Waveform::surveillance;
    if (name == "doppler") return Waveform::doppler;
    if (name != "batch") cut.complain("waveform", "must be surveillance, doppler or batch");
    return Waveform::batch;
}

Cut read_cut(TomlTable& table) {
    Cut cut;
    cut.elevation_deg = nearest_elevation_deg(needed_number(table, "elevation_deg", {-1, 60}));
    cut.waveform = read_waveform(table);
    cut.azimuth_rate_deg_s =
        nearest_rate_deg_s(needed_number(table, "azimuth_rate_deg_s", {1, 40}));
    const double spacing_deg = table.number("azimuth_spacing_deg", {0.5, 1}).value_or(1);
    if (spacing_deg != 0.5 && spacing_deg != 1) {
        table.complain("azimuth_spacing_deg", "must be 0.5 or 1");
    }
    cut.azimuth_spacing_deg = static_cast<float>(spacing_deg);
    cut.surveillance_prf = cut.waveform == Waveform::doppler ? 0 : 1;
    cut.doppler_prf = table.whole_number("doppler_prf", {4, 8}).value_or(6);
    if (!has_velocity(cut)) cut.doppler_prf = 0;
    const auto nyquist_mps = table.number("nyquist_mps", nyquists_mps);
    // Message 31 holds hundredths of m/s.
    if (nyquist_mps) cut.nyquist_mps = static_cast<float>(std::round(*nyquist_mps * 100)) / 100.0F;
    if (nyquist_mps && !has_velocity(cut)) {
        table.complain("nyquist_mps", "is for cuts with velocity");
    }
    return cut;
}

Pattern read_pattern(TomlTable& volumes, TomlTable& root) {
    auto cuts = root.tables("cut");
    if (cuts.empty()) {
        const int number = needed_whole_number(volumes, "vcp", {1, 999});
        const Pattern* known = find_pattern(number);
        if (known != nullptr) return *known;
        volumes.complain(
            "vcp", fmt::format("{} is not one of {}; other patterns need [[cut]] tables", number,
                               fmt::join(pattern_numbers(), ", ")));
        return {};
    }
    Pattern pattern;
    pattern.number = volumes.whole_number("vcp", {1, 767}).value_or(767);
    if (cuts.size() > 32) root.complain("cut", "there are more than 32 cuts");
    for (TomlTable& cut : cuts) {
        pattern.cuts.push_back(read_cut(cut));
    }
    return pattern;
}

Schedule read_schedule(TomlTable volumes, TomlTable& root) {
    Schedule schedule;
    schedule.count = needed_whole_number(volumes, "count", {1, 10000});
    const std::string start = needed_text(volumes, "start");
    // "now" and relative times would make a scene differ from run to run.
    const bool fixed = !start.empty() && start.front() >= '0' && start.front() <= '9';
    const auto time = fixed ? parse_utc(start, UtcTime{}) : Result<UtcTime>(UtcTime{});
    if (!fixed || !time) {
        volumes.complain("start", "must be a time, as in \"2024-06-01T22:00:00Z\"");
    }
    if (time) schedule.start = *time;
    schedule.pattern = read_pattern(volumes, root);
    const double needed_s = duration_s(schedule.pattern);
    schedule.interval_s = volumes.number("interval_s", {1, 86400}).value_or(300);
    if (schedule.interval_s < needed_s) {
        volumes.complain(
            "interval_s",
            fmt::format("{} s is shorter than the {:.0f} s that VCP {} takes", schedule.interval_s,
                        std::ceil(needed_s), schedule.pattern.number));
    }
    return schedule;
}

Footprint read_footprint(TomlTable& table) {
    Footprint footprint;
    const Pair position_km = needed_pair(table, "position_km", places_km);
    const Pair velocity_mps = pair_or(table, "velocity_mps", speeds_mps, {});
    const Pair radii_km = needed_pair(table, "radii_km", lengths_km);
    footprint.x_m = position_km.first * km;
    footprint.y_m = position_km.second * km;
    footprint.motion = {velocity_mps.first, velocity_mps.second};
    footprint.major_m = radii_km.first * km;
    footprint.minor_m = radii_km.second * km;
    footprint.orientation_deg = table.number("orientation_deg", directions_deg).value_or(0);
    return footprint;
}

Ripple read_ripple(TomlTable& table) {
    Ripple ripple;
    ripple.most_db = table.number("ripple_db", {0, 20}).value_or(0);
    ripple.length_m = table.number("ripple_length_km", lengths_km).value_or(5) * km;
    return ripple;
}

Hook read_hook(TomlTable& table) {
    Hook hook;
    const Pair center_km = needed_pair(table, "center_km", {-100, 100});
    hook.x_m = center_km.first * km;
    hook.y_m = center_km.second * km;
    hook.radius_m = needed_number(table, "radius_km", {0.1, 100}) * km;
    const Pair arc_deg = needed_pair(table, "arc_deg", {-360, 720});
    if (arc_deg.second <= arc_deg.first || arc_deg.second - arc_deg.first >= 360) {
        table.complain("arc_deg", "must be [from, to], clockwise and less than a full circle");
    }
    hook.from_deg = arc_deg.first;
    hook.to_deg = arc_deg.second;
    hook.width_m = needed_number(table, "width_km", lengths_km) * km;
    hook.top_m = needed_number(table, "top_km", {0.1, 30}) * km;
    hook.peak_dbz = needed_number(table, "peak_dbz", peaks_dbz);
    return hook;
}

Storm read_storm(TomlTable& table) {
    Storm storm;
    storm.footprint = read_footprint(table);
    storm.core_m = needed_number(table, "core_km", heights_km) * km;
    storm.top_m = needed_number(table, "top_km", heights_km) * km;
    if (storm.top_m <= storm.core_m) table.complain("top_km", "must be above core_km");
    storm.peak_dbz = needed_number(table, "peak_dbz", peaks_dbz);
    const Pair tilt = pair_or(table, "tilt", {-10, 10}, {});
    storm.tilt_east = tilt.first;
    storm.tilt_north = tilt.second;
    storm.ripple = read_ripple(table);
    if (auto hook = table.table("hook")) storm.hook = read_hook(*hook);
    return storm;
}

// Reads the keys that layers and boxes have in common: footprint, base and top, and strength.
template <class Echo>
Echo read_slab(TomlTable& table) {
    Echo echo;
    echo.footprint = read_footprint(table);
    echo.base_m = table.number("base_km", heights_km).value_or(0) * km;
    echo.top_m = needed_number(table, "top_km", heights_km) * km;
    if (echo.top_m <= echo.base_m) table.complain("top_km", "must be above base_km");
    echo.peak_dbz = needed_number(table, "peak_dbz", peaks_dbz);
    return echo;
}

Layer read_layer(TomlTable& table) {
    auto layer = read_slab<Layer>(table);
    layer.melting_m = table.number("melting_km", heights_km).value_or(3.5) * km;
    layer.bright_band_db = table.number("bright_band_db", {0, 30}).value_or(0);
    layer.bright_band_depth_m = table.number("bright_band_depth_km", {0.05, 5}).value_or(0.3) * km;
    layer.lapse_db_per_m = table.number("lapse_db_per_km", {0, 50}).value_or(3) / km;
    layer.ripple = read_ripple(table);
    return layer;
}

Wave read_wave(TomlTable table) {
    Wave wave;
    wave.most_db = table.number("wave_db", {0, 40}).value_or(0);
    wave.length_m = table.number("wave_length_km", lengths_km).value_or(10) * km;
    wave.azimuth_deg = table.number("wave_azimuth_deg", directions_deg).value_or(90);
    return wave;
}

Box read_box(TomlTable& table) {
    auto box = read_slab<Box>(table);
    box.edge_m = table.number("edge_km", {0.001, 100}).value_or(0.5) * km;
    box.wave = read_wave(table);
    return box;
}

WindLevel read_wind_level(TomlTable& table) {
    const Pair velocity_mps = needed_pair(table, "velocity_mps", speeds_mps);
    return {table.number("height_km", heights_km).value_or(0) * km,
            {velocity_mps.first, velocity_mps.second}};
}

Vortex read_vortex(TomlTable& table) {
    Vortex vortex;
    const Pair position_km = needed_pair(table, "position_km", places_km);
    const Pair drift_mps = pair_or(table, "velocity_mps", speeds_mps, {});
    vortex.x_m = position_km.first * km;
    vortex.y_m = position_km.second * km;
    vortex.motion = {drift_mps.first, drift_mps.second};
    vortex.radius_m = needed_number(table, "radius_km", lengths_km) * km;
    if (!table.has("tangential_mps") && !table.has("radial_mps")) {
        table.complain("tangential_mps", "is missing, and so is radial_mps");
    }
    vortex.tangential_mps = table.number("tangential_mps", speeds_mps).value_or(0);
    vortex.radial_mps = table.number("radial_mps", speeds_mps).value_or(0);
    vortex.decay = table.number("decay", {0, 5}).value_or(1);
    if (const auto base = table.number("base_km", heights_km)) vortex.base_m = *base * km;
    if (const auto top = table.number("top_km", heights_km)) vortex.top_m = *top * km;
    if (vortex.top_m <= vortex.base_m) table.complain("top_km", "must be above base_km");
    return vortex;
}

Wind read_wind(TomlTable& table) {
    Wind wind;
    for (TomlTable& row : table.tables("level")) {
        const WindLevel level = read_wind_level(row);
        if (!wind.levels.empty() && level.height_m <= wind.levels.back().height_m) {
            row.complain("height_km", "must be above the level before");
        }
        wind.levels.push_back(level);
    }
    for (TomlTable& row : table.tables("vortex")) {
        wind.vortices.push_back(read_vortex(row));
    }
    if (wind.levels.empty() && wind.vortices.empty()) {
        table.complain("level", "is missing, and so is vortex");
    }
    return wind;
}

// Returns the place of the radar in the plane about the weather's own origin. Returns none if the
// radar is at the origin.
std::optional<Stand> read_stand(TomlTable weather, const Site& site) {
    const bool has_latitude = weather.has("latitude_deg");
    if (has_latitude != weather.has("longitude_deg")) {
        weather.complain(has_latitude ? "longitude_deg" : "latitude_deg", "is missing");
        return std::nullopt;
    }
    const auto latitude_deg = weather.number("latitude_deg", {-90, 90});
    const auto longitude_deg = weather.number("longitude_deg", {-180, 180});
    if (!latitude_deg || !longitude_deg) return std::nullopt;
    return stand_of(site, *latitude_deg, *longitude_deg);
}

// Refuses the scenes of pictures, because these are .toml files, too.
Status check_kind(const TomlTable& root, const std::string& name) {
    if (root.has("radar")) return {};
    for (const char* section : {"picture", "camera", "light", "volume", "labels", "plan", "loop"}) {
        if (!root.has(section)) continue;
        return fail(ErrorCode::bad_argument,
                    "{}: this is a picture scene ([{}]) for stormcellar frame and loop; a "
                    "simulated scene has [radar]",
                    name, section);
    }
    return {};
}

Result<Scene> scene_of(TomlFile& file, const std::string& name) {
    TomlTable root = file.root();
    if (auto kind = check_kind(root, name); !kind) return pass_on(kind);
    Scene scene;
    scene.site = read_site(root.section("radar"));
    scene.schedule = read_schedule(root.section("volumes"), root);
    for (TomlTable& table : root.tables("storm")) {
        scene.weather.storms.push_back(read_storm(table));
    }
    for (TomlTable& table : root.tables("layer")) {
        scene.weather.layers.push_back(read_layer(table));
    }
    for (TomlTable& table : root.tables("box")) {
        scene.weather.boxes.push_back(read_box(table));
    }
    if (auto wind = root.table("wind")) scene.weather.wind = read_wind(*wind);
    if (const auto stand = read_stand(root.section("weather"), scene.site)) {
        scene.weather = seen_from(scene.weather, *stand);
    }
    scene.instrument = read_instrument(root.section("instrument"),
                                       static_cast<int>(scene.schedule.pattern.cuts.size()));
    if (const Status read = file.finish(); !read) return pass_on(read);
    return scene;
}

}  // namespace

Stand stand_of(const Site& site, double latitude_deg, double longitude_deg) {
    const grid::SiteFrame origin(latitude_deg, longitude_deg);
    const grid::SiteFrame radar(site.latitude_deg, site.longitude_deg);
    const grid::PolarPoint there = origin.to_polar({site.latitude_deg, site.longitude_deg});
    const grid::PolarPoint back = radar.to_polar({latitude_deg, longitude_deg});
    const grid::PlanePoint place = grid::SiteFrame::to_plane(there);
    // At the origin the plane is not turned.
    const double turn_deg =
        there.arc_m > 0 ? std::remainder(there.azimuth_deg + 180 - back.azimuth_deg, 360) : 0;
    return {place.x_m, place.y_m, turn_deg};
}

UtcTime Schedule::start_of(int volume) const {
    return start + std::chrono::milliseconds(std::llround(1000 * interval_s * volume));
}

Result<Scene> parse_scene(std::string_view toml, const std::string& name) {
    auto file = TomlFile::parse(toml, name);
    if (!file) return pass_on(file);
    return scene_of(*file, name);
}

Result<Scene> read_scene(const std::filesystem::path& path) {
    auto file = TomlFile::open(path);
    if (!file) return pass_on(file);
    return scene_of(*file, path.native());
}

}  // namespace stormcellar::synth
