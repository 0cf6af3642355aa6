#include "daemon/config/config.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "base/added_stations.h"
#include "base/byte_size.h"
#include "base/printable.h"
#include "base/toml_file.h"
#include "daemon/config/station_config.h"
#include "pipeline/options/domain.h"
#include "service/config_keys.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_name.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::daemon {
namespace {

constexpr std::size_t most_socket_bytes = 107;  // size of sun_path without the final zero

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
    // Remove the empty last part of a path such as "a/". With the empty part, the comparison would
    // not find that "a/b" is within "a/".
    if (!resolved.has_filename() && resolved.has_parent_path()) resolved = resolved.parent_path();
    return resolved;
}

void read_path(TomlTable& paths, std::string_view key, const std::filesystem::path& file,
               std::filesystem::path& path) {
    const std::optional<std::string> text = paths.text(key);
    if (text && text->empty()) {
        paths.complain(key, "must not be empty");
    } else if (text) {
        path = resolve(*text, file);
    }
}

void read_paths(TomlTable paths, const std::filesystem::path& file, PathsConfig& config) {
    read_path(paths, "drop", file, config.drop);
    read_path(paths, "state", file, config.state);
    read_path(paths, "cache", file, config.cache);
    if (config.drop.empty()) {
        paths.complain("drop", "must be given; it is the drop directory");
        return;
    }
    using Named = std::pair<std::string_view, const std::filesystem::path*>;
    const std::array<Named, 3> all = {
        Named{"drop", &config.drop}, {"state", &config.state}, {"cache", &config.cache}};
    for (const auto& [name, path] : all) {
        for (const auto& [other_name, other] : all) {
            if (name == other_name || !is_within(*path, *other)) continue;
            paths.complain(
                name,
                fmt::format(
                    "{} is the same as or within {} ({}); the three directories must be separate",
                    path->native(), other->native(), other_name));
        }
    }
}

constexpr std::chrono::seconds second{1}, hour{3600}, day{86'400};

void read_whole_seconds(TomlTable& table, std::string_view key, TomlRange range,
                        std::chrono::seconds& value) {
    if (const auto seconds = table.whole_number(key, range)) {
        value = std::chrono::seconds{*seconds};
    }
}

void read_levels(TomlTable& ingest, GridConfig& config) {
    if (const auto levels_m = pipeline::read_levels_m(ingest)) config.levels_m = *levels_m;
}

void read_size(TomlTable& ingest, GridConfig& config) {
    if (const auto spacing = ingest.number("spacing_km", {0.05, 100})) {
        config.spacing_m = *spacing * 1000;
    }
    std::vector<double> extent_km = {460, 460};
    if (const auto given = ingest.numbers("extent_km")) {
        if (given->size() != 2) {
            ingest.complain("extent_km", "must be [width, height]");
            return;
        }
        extent_km = *given;
    }
    std::array<int, 2> counts{};
    for (std::size_t i = 0; i < 2; ++i) {
        const double cells = extent_km[i] * 1000 / config.spacing_m;
        if (!(cells >= 1 && cells <= 16384) || std::abs(cells - std::round(cells)) > 1e-6) {
            ingest.complain("extent_km", fmt::format("{} km is not 1 to 16384 cells of {} km",
                                                     extent_km[i], config.spacing_m / 1000));
            return;
        }
        counts[i] = static_cast<int>(std::lround(cells));
    }
    config.nx = counts[0];
    config.ny = counts[1];
}

// Checks the rules of the grid library when the file is read. Complaints name levels_km, even if
// the extent or the number of cells is the cause.
void check_grid(TomlTable& ingest, const GridConfig& config) {
    grid::GridSpec spec = grid::default_spec(0, 0);
    spec.spacing_m = config.spacing_m;
    spec.nx = config.nx;
    spec.ny = config.ny;
    if (!config.levels_m.empty()) spec.levels_m = config.levels_m;
    if (const Status valid = grid::validate(spec); !valid) {
        ingest.complain("levels_km", valid.error().message);
    }
}

void read_bunzip(TomlTable& ingest, IngestConfig& config) {
    const auto name = ingest.text("bunzip");
    if (!name || *name == "fastest") return;
    const auto path = bunzip::path_named(*name);
    if (!path) {
        ingest.complain("bunzip",
                        fmt::format("\"{}\" must be one of fastest, libbz2, plain, avx2, avx512",
                                    printable(*name)));
    } else if (!bunzip::is_available(*path)) {
        ingest.complain("bunzip",
                        fmt::format("the processor of this machine does not support {}", *name));
    } else {
        config.bunzip = path;
    }
}

int processors() {
    // Keep the number, because each turn of the service needs it, and hardware_concurrency() reads
    // a file.
    static const unsigned count = std::thread::hardware_concurrency();
    return std::max(1, static_cast<int>(count));
}

// Reads the moments. `moment` is an older key that names a single moment.
void read_moments(TomlTable& ingest, GridConfig& config) {
    const auto one = ingest.text("moment");
    const auto several = pipeline::read_moments(ingest, "moments");
    if (one && several) {
        ingest.complain("moment", "cannot be given together with moments; give one of the two");
        return;
    }
    if (several && !several->empty()) config.moments = *several;
    if (!one) return;
    if (const auto moment = pipeline::read_moment(ingest, "moment", *one)) {
        config.moments = {*moment};
    }
}

// Reads the dealiasing method. Moments derived from velocity (VELD, SRV, AZSH, DIVG) need dealiased
// velocities.
void read_dealiasing(TomlTable& ingest, GridConfig& config) {
    const auto name = ingest.text("dealias");
    if (!name) return;
    const auto rung = retrieve::dealiasing_from_name(*name);
    if (!rung) return ingest.complain("dealias", rung.error().message);
    const auto derived = std::ranges::find_if(config.moments, level2::is_dealiased);
    if (*rung == retrieve::Dealiasing::off && derived != config.moments.end())
        return ingest.complain("dealias", fmt::format("\"off\" does not go with the moment {}, "
                                                      "which is dealiased",
                                                      level2::moment_name(*derived)));
    config.dealiasing = *rung;
}

void read_grid(TomlTable& ingest, GridConfig& config) {
    config.threads = ingest.whole_number("threads", {0, 256}).value_or(0);
    if (config.threads == 0) config.threads = processors();
    read_moments(ingest, config);
    read_dealiasing(ingest, config);
    if (const auto quality = ingest.number("quality", {0, 1})) config.quality = *quality;
    read_size(ingest, config);
    read_levels(ingest, config);
    check_grid(ingest, config);
}

void read_ingest(TomlTable ingest, FixedConfig& fixed, ReloadableConfig& reloadable) {
    IngestConfig& config = fixed.ingest;
    if (const auto workers = ingest.whole_number("workers", {0, 256})) {
        reloadable.workers = *workers;
    }
    config.stations = read_station_rule(ingest);
    if (const auto living = ingest.flag("living")) config.living = *living;
    read_duration(ingest, "quiet_seconds", {1, 86400}, second, reloadable.quiet);
    read_whole_seconds(ingest, "chunk_timeout_seconds", {1, 86400}, config.chunk_timeout);
    read_whole_seconds(ingest, "chunk_grace_seconds", {0, 86400}, config.chunk_grace);
    read_duration(ingest, "reread_seconds", {0, 60}, second, reloadable.reread);
    read_bunzip(ingest, config);
    read_grid(ingest, fixed.grid);
}

void read_storage(TomlTable& table, StorageConfig& config) {
    read_duration(table, "refill_hours", {0, 8760}, hour, config.refill);
    if (const auto name = table.text("compression")) {
        if (*name == "none" || *name == "lz4") {
            config.packing = *name == "lz4" ? cache::Packing::lz4 : cache::Packing::none;
        } else {
            table.complain("compression",
                           fmt::format("\"{}\" must be one of none, lz4", printable(*name)));
        }
    }
}

void read_bytes(TomlTable& table, std::optional<std::uint64_t>& bytes) {
    std::uint64_t given = 0;
    if (table.is_text("bytes")) {
        const auto size = parse_byte_size(*table.text("bytes"));
        if (!size) return table.complain("bytes", size.error().message);
        given = *size;
    } else if (const auto number = table.number("bytes", {0, 1e15})) {
        given = static_cast<std::uint64_t>(*number);
    } else {
        return;
    }
    bytes = given == 0 ? std::nullopt : std::optional{given};
}

void read_catalog(TomlTable catalog, Config& config) {
    read_bytes(catalog, config.fixed.storage.catalog_bytes);
    read_duration(catalog, "gone_days", {0, 36500}, day, config.reloadable.gone_rows_kept_for);
}

void read_watch(TomlTable watch, Config& config) {
    read_duration(watch, "rescan_seconds", {1, 86400}, second, config.reloadable.rescan);
    read_duration(watch, "poll_seconds", {1, 86400}, second, config.reloadable.poll);
    if (const auto limit = watch.whole_number("queue_limit", {16, 10'000'000})) {
        config.fixed.queue_limit = static_cast<std::size_t>(*limit);
    }
}

void read_status(TomlTable status, const std::filesystem::path& file, const PathsConfig& paths,
                 StatusConfig& config) {
    read_path(status, "socket", file, config.socket);
    const std::filesystem::path& socket = config.socket;
    for (const std::filesystem::path* path : {&paths.drop, &paths.cache}) {
        if (socket.empty() || path->empty() || !is_within(socket, *path)) continue;
        status.complain("socket", fmt::format("{} is within {}", socket.native(), path->native()));
    }
    if (socket.native().size() > most_socket_bytes) {
        status.complain("socket", fmt::format("has more than {} bytes", most_socket_bytes));
    }
    if (const auto port = status.whole_number("http_port", {0, 65'535})) {
        config.http_port = *port;
    }
}

// Returns the reason why the directory cannot be used for the partials of another machine. Returns
// an empty text if the directory can be used.
std::string reason_against(const std::filesystem::path& directory, const FixedConfig& config) {
    const std::string name = directory.filename().native();
    if (!cache::is_domain_name(name) || cache::is_part(name)) {
        return fmt::format("{} is not a valid name of a machine: letters, digits, _ and -",
                           printable(name));
    }
    for (const auto* path : {&config.paths.drop, &config.paths.state, &config.paths.cache}) {
        if (!path->empty() && (is_within(directory, *path) || is_within(*path, directory)))
            return fmt::format("{} and {} must be separate", directory.native(), path->native());
    }
    for (const std::filesystem::path& other : config.partials.directories) {
        if (is_within(directory, other) || is_within(other, directory))
            return fmt::format("{} and {} must be separate", directory.native(), other.native());
        if (other.filename() == name) return fmt::format("two machines have the name {}", name);
    }
    return {};
}

void read_partial_stations(TomlTable stations, PartialsConfig& config) {
    constexpr std::size_t most_stations = 1024;
    for (const std::filesystem::path& directory : config.directories) {
        const std::string name = directory.filename().native();
        const auto listed = stations.texts(name);
        if (!listed) continue;
        if (listed->size() > most_stations)
            stations.complain(name, fmt::format("has more than {} entries", most_stations));
        for (const std::string& icao : *listed) {
            if (!is_icao(icao))
                stations.complain(name, fmt::format("{} is not an ICAO", printable(icao)));
        }
        config.stations[name] = *listed;
    }
}

void read_partials(TomlTable partials, const std::filesystem::path& file, FixedConfig& config) {
    constexpr std::size_t most_machines = 64;
    read_whole_seconds(partials, "late_after_seconds", {10, 86400}, config.partials.late_after);
    const auto directories = partials.texts("directories").value_or(std::vector<std::string>{});
    if (directories.size() > most_machines) {
        partials.complain("directories", fmt::format("has more than {} entries", most_machines));
        return;
    }
    for (const std::string& text : directories) {
        const auto directory = resolve(text, file);
        const auto why = text.empty() ? "must not be empty" : reason_against(directory, config);
        if (!why.empty()) return partials.complain("directories", why);
        config.partials.directories.push_back(directory);
    }
    read_partial_stations(partials.section("stations"), config.partials);
}

void read_budget(TomlTable& table, cache::Budget& budget) {
    read_bytes(table, budget.bytes);
    if (const auto percent = table.number("percent", {0, 100})) {
        budget.file_system_percent = *percent == 0 ? std::nullopt : percent;
    }
    if (const auto hours = table.number("age_hours", {0, 1e6})) {
        budget.age =
            *hours == 0
                ? std::nullopt
                : std::optional{std::chrono::milliseconds{std::llround(*hours * 3600 * 1000)}};
    }
}

void read_budgets(TomlTable& cache, cache::Budgets& budgets) {
    read_budget(cache, budgets.total);
    if (const auto share = cache.number("low_watermark", {0.01, 1})) budgets.low_watermark = *share;
    read_duration(cache, "protect_hours", {0, 1e6}, hour, budgets.protected_for);
    for (TomlTable& domain : cache.tables("domain")) {
        cache::Budget budget;
        read_budget(domain, budget);
        const auto name = domain.text("name");
        if (!name) {
            if (!domain.has("name")) domain.complain("name", "must be given");
        } else if (*name == "*") {
            budgets.every_domain = budget;
        } else if (!cache::is_domain_name(*name) || cache::is_part(*name)) {
            domain.complain(
                "name", fmt::format("\"{}\" is not a valid name of a domain", printable(*name)));
        } else if (!budgets.domains.emplace(*name, budget).second) {
            domain.complain("name", fmt::format("\"{}\" is named twice", *name));
        }
    }
}

void read_cache(TomlTable cache, Config& config) {
    read_budgets(cache, config.reloadable.budgets);
    read_storage(cache, config.fixed.storage);
}

}  // namespace

cache::Budgets default_budgets() {
    cache::Budgets budgets;
    budgets.total.file_system_percent = 95;
    return budgets;
}

std::filesystem::path default_socket(const std::filesystem::path& state,
                                     const char* runtime_directory) {
    std::string directory = runtime_directory == nullptr ? "" : runtime_directory;
    directory = directory.substr(0, directory.find(':'));
    return (directory.empty() ? state : std::filesystem::path{directory}) / "status.sock";
}

int ReloadableConfig::worker_count() const {
    return workers > 0 ? workers : processors();
}

std::vector<std::string> needs_restart(const FixedConfig& fresh, const FixedConfig& running) {
    std::vector<std::string> sentences;
    // This line no longer compiles if FixedConfig gets a further member. Then write a sentence for
    // that member below.
    const auto& [paths, grid, queue_limit, ingest, storage, status, partials] = fresh;
    if (paths != running.paths) {
        sentences.emplace_back("restart the service for the change of [paths] to take effect");
    }
    if (grid != running.grid || queue_limit != running.queue_limit) {
        sentences.emplace_back(
            "restart the service for changes of moment, moments, dealias, quality, spacing_km, "
            "extent_km, levels_km, threads, queue_limit and [[domain]] to take effect");
    }
    if (ingest != running.ingest || storage != running.storage) {
        sentences.emplace_back(
            "restart the service for changes of stations, living, chunk_timeout_seconds, "
            "chunk_grace_seconds, bunzip, refill_hours, compression, [catalog] bytes and "
            "[[station]] to take effect");
    }
    if (status != running.status) {
        sentences.emplace_back("restart the service for the change of [status] to take effect");
    }
    if (partials != running.partials) {
        sentences.emplace_back("restart the service for the change of [partials] to take effect");
    }
    return sentences;
}

Result<Config> load_config(const std::filesystem::path& file, SceneFiles scenes) {
    Result<TomlFile> toml = TomlFile::open(file);
    if (!toml) return pass_on(toml);
    TomlTable root = toml->root();
    Config config;
    FixedConfig& fixed = config.fixed;
    read_paths(root.section("paths"), file, fixed.paths);
    read_ingest(root.section("ingest"), fixed, config.reloadable);
    fixed.ingest.added_stations = read_added_stations(root);
    fixed.grid.domains = pipeline::read_domains(root);
    read_cache(root.section("cache"), config);
    read_catalog(root.section("catalog"), config);
    read_watch(root.section("watch"), config);
    read_log_level(root, config.reloadable.log_level);
    read_status(root.section("status"), file, fixed.paths, fixed.status);
    read_partials(root.section("partials"), file, fixed);
    root.leave("pull");    // stormcellar-pull checks this table
    root.leave("feed");    // stormcellar-feed checks this table
    root.leave("notify");  // stormcellar-notify checks this table
    config.reloadable.loops =
        read_loops(root, std::filesystem::absolute(file).parent_path(),
                   {fixed.paths.drop, fixed.paths.state, fixed.paths.cache}, scenes);
    config.reloadable.web = web::read_web_config(root);
    if (const Status read = toml->finish(); !read) return pass_on(read);
    return config;
}

bool PartialsConfig::may_bring(const std::string& machine, const std::string& station) const {
    const auto lists = [&](const auto& one) {
        return std::ranges::find(one.second, station) != one.second.end();
    };
    const auto own = stations.find(machine);
    return own != stations.end() ? lists(*own) : std::ranges::none_of(stations, lists);
}

}  // namespace stormcellar::daemon
