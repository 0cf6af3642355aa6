#include "daemon/config.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "base/printable.h"
#include "daemon/toml_reader.h"
#include "grid/grid_spec.h"
#include "level2/volume.h"

namespace stormcellar::daemon {
namespace {

constexpr std::size_t most_levels = 1024;

bool is_within(const std::filesystem::path& path, const std::filesystem::path& directory) {
    const auto end = std::mismatch(directory.begin(), directory.end(), path.begin(), path.end());
    return end.first == directory.end();
}

std::filesystem::path resolve(const std::filesystem::path& path,
                              const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path base = std::filesystem::absolute(file, error).parent_path();
    std::filesystem::path resolved = std::filesystem::weakly_canonical(base / path, error);
    if (error) resolved = (base / path).lexically_normal();
    // "a/" has an empty last part, which would hide that "a/b" lies within.
    if (!resolved.has_filename() && resolved.has_parent_path()) resolved = resolved.parent_path();
    return resolved;
}

void read_path(TomlReader& reader, std::string_view key, const std::filesystem::path& file,
               std::filesystem::path& path) {
    const std::optional<std::string> text = reader.text("paths", key);
    if (text && text->empty()) {
        reader.complain("paths", key, "must not be empty");
    } else if (text) {
        path = resolve(*text, file);
    }
}

void read_paths(TomlReader& reader, const std::filesystem::path& file, Config& config) {
    read_path(reader, "drop", file, config.drop);
    read_path(reader, "state", file, config.state);
    read_path(reader, "cache", file, config.cache);
    if (config.drop.empty()) {
        reader.complain("paths", "drop", "the drop directory must be named");
        return;
    }
    using Named = std::pair<std::string_view, const std::filesystem::path*>;
    const std::array<Named, 3> all = {
        Named{"drop", &config.drop}, {"state", &config.state}, {"cache", &config.cache}};
    for (const auto& [name, path] : all) {
        for (const auto& [other_name, other] : all) {
            if (name == other_name || !is_within(*path, *other)) continue;
            reader.complain("paths", name,
                            fmt::format("{} is or lies within {} ({}); the three must be apart",
                                        path->native(), other->native(), other_name));
        }
    }
}

std::chrono::milliseconds milliseconds_of(double seconds) {
    return std::chrono::milliseconds{std::llround(seconds * 1000)};
}

void read_seconds(TomlReader& reader, std::string_view section, std::string_view key, double least,
                  double most, std::chrono::milliseconds& value) {
    if (const auto seconds = reader.number(section, key, least, most)) {
        value = milliseconds_of(*seconds);
    }
}

// "bottom:top:step" in kilometres -> metres; none when it is not of that form.
std::optional<std::vector<double>> expand_levels(const std::string& text) {
    std::array<double, 3> parts{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto [next, error] = std::from_chars(at, end, parts[i]);
        if (error != std::errc{} || !std::isfinite(parts[i])) return std::nullopt;
        const bool last = i + 1 == parts.size();
        if (last ? next != end : next == end || *next != ':') return std::nullopt;
        at = last ? end : next + 1;
    }
    const auto [bottom, top, step] = parts;
    if (!(step > 0) || !(top >= bottom) || (top - bottom) / step >= most_levels) {
        return std::nullopt;
    }
    // A top that the steps reach but for rounding is reached.
    const auto steps = static_cast<int>(std::floor((top - bottom) / step + 1e-6));
    std::vector<double> levels_m;
    for (int i = 0; i <= steps; ++i)
        levels_m.push_back(std::round((bottom + i * step) * 1e6) * 1e-3);
    return levels_m;
}

void read_levels(TomlReader& reader, Config& config) {
    if (reader.is_array("ingest", "levels_km")) {
        const auto levels_km = reader.numbers("ingest", "levels_km");
        if (!levels_km) return;
        config.ingest.levels_m.clear();
        for (const double level : *levels_km)
            config.ingest.levels_m.push_back(level * 1000);
        if (levels_km->empty()) reader.complain("ingest", "levels_km", "must name a level");
    } else if (const auto text = reader.text("ingest", "levels_km")) {
        const auto levels_m = expand_levels(*text);
        if (!levels_m) {
            reader.complain("ingest", "levels_km",
                            fmt::format("\"{}\" is not BOTTOM:TOP:STEP, as in \"0.5:16:0.5\"",
                                        printable(*text)));
            return;
        }
        config.ingest.levels_m = *levels_m;
    }
}

void read_size(TomlReader& reader, Config& config) {
    if (const auto spacing = reader.number("ingest", "spacing_km", 0.05, 100)) {
        config.ingest.spacing_m = *spacing * 1000;
    }
    std::vector<double> extent_km = {460, 460};
    if (const auto given = reader.numbers("ingest", "extent_km")) {
        if (given->size() != 2) {
            reader.complain("ingest", "extent_km", "must be [width, height]");
            return;
        }
        extent_km = *given;
    }
    std::array<int, 2> counts{};
    for (std::size_t i = 0; i < 2; ++i) {
        const double cells = extent_km[i] * 1000 / config.ingest.spacing_m;
        if (!(cells >= 1 && cells <= 16384) || std::abs(cells - std::round(cells)) > 1e-6) {
            reader.complain("ingest", "extent_km",
                            fmt::format("{} km is not 1 to 16384 cells of {} km", extent_km[i],
                                        config.ingest.spacing_m / 1000));
            return;
        }
        counts[i] = static_cast<int>(std::lround(cells));
    }
    config.ingest.nx = counts[0];
    config.ingest.ny = counts[1];
}

void read_ingest(TomlReader& reader, Config& config) {
    if (const auto workers = reader.whole_number("ingest", "workers", 0, 256)) {
        config.workers = *workers;
    }
    if (const auto threads = reader.whole_number("ingest", "threads", 0, 256)) {
        config.ingest.decode_threads = *threads;
    } else {
        config.ingest.decode_threads = 0;
    }
    if (config.ingest.decode_threads == 0) {
        config.ingest.decode_threads =
            std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    }
    config.ingest.grid_threads = config.ingest.decode_threads;
    read_seconds(reader, "ingest", "quiet_seconds", 1, 86400, config.quiet);
    read_seconds(reader, "ingest", "reread_seconds", 0, 60, config.reread);
    if (const auto name = reader.text("ingest", "moment")) {
        const auto moment = level2::moment_from_name(*name);
        if (moment) {
            config.ingest.moment = *moment;
        } else {
            reader.complain("ingest", "moment",
                            fmt::format("\"{}\" is no moment; one of REF VEL SW ZDR PHI RHO CFP",
                                        printable(*name)));
        }
    }
    read_size(reader, config);
    read_levels(reader, config);
}

// What the grid room would refuse is refused here, with the line.
void check_grid(TomlReader& reader, const Config& config) {
    grid::GridSpec spec = grid::default_spec(0, 0);
    spec.spacing_m = config.ingest.spacing_m;
    spec.nx = config.ingest.nx;
    spec.ny = config.ingest.ny;
    if (!config.ingest.levels_m.empty()) spec.levels_m = config.ingest.levels_m;
    if (const Status valid = grid::validate(spec); !valid) {
        reader.complain("ingest", "levels_km", valid.error().message);
    }
}

void read_rest(TomlReader& reader, Config& config) {
    read_seconds(reader, "watch", "rescan_seconds", 1, 86400, config.rescan);
    if (const auto limit = reader.whole_number("watch", "queue_limit", 16, 10'000'000)) {
        config.queue_limit = static_cast<std::size_t>(*limit);
    }
    if (const auto level = reader.text("log", "level")) {
        static constexpr std::array<std::string_view, 4> levels = {"debug", "info", "warning",
                                                                   "error"};
        if (std::find(levels.begin(), levels.end(), *level) == levels.end()) {
            reader.complain(
                "log", "level",
                fmt::format("\"{}\" is none of debug, info, warning, error", printable(*level)));
        } else {
            config.log_level = *level;
        }
    }
}

}  // namespace

int Config::worker_count() const {
    if (workers > 0) return workers;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

bool same_grids(const pipeline::IngestOptions& a, const pipeline::IngestOptions& b) {
    return a.moment == b.moment && a.spacing_m == b.spacing_m && a.nx == b.nx && a.ny == b.ny &&
           a.levels_m == b.levels_m && a.decode_threads == b.decode_threads &&
           a.grid_threads == b.grid_threads;
}

Result<Config> load_config(const std::filesystem::path& file) {
    Result<TomlReader> reader = TomlReader::open(file);
    if (!reader) return pass_on(reader);
    Config config;
    read_paths(*reader, file, config);
    read_ingest(*reader, config);
    check_grid(*reader, config);
    read_rest(*reader, config);
    if (const Status read = reader->finish(); !read) return tl::unexpected<Error>(read.error());
    return config;
}

}  // namespace stormcellar::daemon
