// stormcellard: the service. The text below describes its command line.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "base/beneath.h"
#include "base/memory.h"
#include "base/printable.h"
#include "cache/map_guard.h"
#include "daemon/care/caretaker.h"
#include "daemon/care/state_keeper.h"
#include "daemon/config/config.h"
#include "daemon/log/log.h"
#include "daemon/loops/loop_check.h"
#include "daemon/loops/loops_service.h"
#include "daemon/partials/partials_keeper.h"
#include "daemon/service/ingest_sink.h"
#include "daemon/service/service.h"
#include "daemon/status/status_server.h"
#include "daemon/watch/unreadable.h"
#include "pipeline/keep/instance_lock.h"
#include "service/program.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/version.h"

namespace stormcellar::daemon {
namespace {

constexpr std::string_view program = "stormcellard";
constexpr int exit_failed = 1;
constexpr std::string_view no_loops = "--no-loops", loops_only = "--loops-only";

constexpr std::string_view usage =
    "usage: stormcellard --config FILE [--no-loops | --loops-only] [--check-config]\n"
    "  --config FILE    read the configuration from FILE (TOML)\n"
    "  --no-loops       leave the [[loop]] tables to another stormcellard\n"
    "  --loops-only     run the [[loop]] tables and do nothing else\n"
    "  --check-config   check FILE and, without --no-loops, its loops' scenes, and exit\n"
    "  --version, --help\n";

// The growing volumes and the databases of all stations take some 1,000 descriptors.
constexpr std::uint64_t wanted_descriptors = 16'384;

Status make_directory(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) return fail(ErrorCode::io, "{}: {}", path.native(), error.message());
    return {};
}

// Returns the part of a path that exists but is not a directory; empty if there is no such part.
std::filesystem::path in_the_way_of(std::filesystem::path directory) {
    std::error_code error;
    while (!std::filesystem::exists(directory, error) && directory.has_relative_path())
        directory = directory.parent_path();
    return std::filesystem::is_directory(directory, error) ? "" : directory;
}

// Warns about settings that are valid but may not be intended.
void print_notes(const Config& config) {
    const PathsConfig& paths = config.fixed.paths;
    const auto note = [](const std::string& what) {
        fmt::print(stderr, "stormcellard: note: {}\n", what);
    };
    if (const auto names = names_beneath(paths.drop, paths.drop); !names) {
        note(fmt::format("cannot read the drop directory {}; the service will wait for it{}",
                         printable(names.error().message),
                         remedy_for(paths.drop, names.error().code)));
    } else if (is_below_home(paths.drop) && std::getenv("INVOCATION_ID") == nullptr) {
        note(
            "the drop directory is below /home, which the units hide from the services "
            "(ProtectHome=); install ldm-in-home.conf for stormcellard and web-ldm-in-home.conf "
            "for stormcellar-web");
    }
    for (const auto& [key, path] : {std::pair{"state", paths.state}, {"cache", paths.cache}}) {
        const std::filesystem::path stands = in_the_way_of(path);
        if (stands.empty()) continue;
        note(fmt::format("[paths] {}: {} is not a directory, so the service cannot start", key,
                         printable(stands.native())));
    }
    for (const std::string& doubt :
         doubts_about(config.reloadable.loops, config.fixed.grid.domains))
        note(doubt);
}

std::unique_ptr<EventSource> open_events() {
    Result<std::unique_ptr<EventSource>> events = open_inotify();
    if (events) return std::move(*events);
    log_warning(
        {Event::watch_failed},
        "cannot watch the drop directory: {}; the service polls it instead ([watch] poll_seconds)",
        printable(events.error().message));
    return no_events();
}

int serve_loops(const Config& config, const std::filesystem::path& file) {
    set_up_logging(config.reloadable.log_level, usual_outlet());
    const std::filesystem::path directory = LoopsService::directory(config);
    if (const Status ready = make_directory(directory); !ready)
        return complain(program, ready.error());
    const auto lock = pipeline::InstanceLock::acquire(directory);
    if (!lock) return complain(program, lock.error());
    const Result<Signals> signals = Signals::open();
    if (!signals) return complain(program, signals.error());
    SystemdNotifier notifier;
    LoopsService(config, file, {notifier, real_file_system(), &*signals}).run();
    return EXIT_SUCCESS;
}

void know_stations(const catalog::CatalogReader& catalog, Service& service) {
    const auto stations = catalog.stations();
    if (!stations) {
        log_warning({Event::stations_unknown},
                    "cannot read the newest volume of each station from the catalog: {}; the "
                    "status starts without them",
                    printable(stations.error().message));
        return;
    }
    for (const catalog::StationSummary& station : *stations)
        if (station.latest) service.know_station(station.station, *station.latest);
}

std::filesystem::path socket_of(const FixedConfig& config) {
    if (!config.status.socket.empty()) return config.status.socket;
    return default_socket(config.paths.state, std::getenv("RUNTIME_DIRECTORY"));
}

int serve(const Config& config, const std::filesystem::path& file, bool runs_loops) {
    keep_freed_memory();
    // Workers need few but large blocks, and hold a lock of malloc for moments only. A worker with
    // an arena of its own could not use the memory that another worker has freed.
    hold_arenas((config.reloadable.worker_count() + 1) / 2);
    cache::install_map_guard();
    raise_descriptor_limit(wanted_descriptors);
    set_up_logging(config.reloadable.log_level, usual_outlet());
    const FixedConfig& fixed = config.fixed;
    StateKeeper state(fixed.paths.state);
    const Status ready = make_directory(fixed.paths.cache).and_then([&] { return state.hold(); });
    if (!ready) return complain(program, ready.error());
    const Result<Signals> signals = Signals::open();
    if (!signals) return complain(program, signals.error());
    const Result<std::unique_ptr<IngestSink>> sink = IngestSink::open(config);
    if (!sink) return complain(program, sink.error());

    const std::unique_ptr<EventSource> events = open_events();
    SystemdNotifier notifier;
    StatusBoard board;
    const std::filesystem::path socket = socket_of(fixed);
    const PartialsKeeper partials(
        fixed.partials,
        {(*sink)->mosaics(), (*sink)->writer(), (*sink)->partial_sources(), (*sink)->stations(),
         fixed.grid.threads},
        {.rescan = config.reloadable.rescan, .poll = config.reloadable.poll});
    Service service(config, file,
                    {.sink = **sink,
                     .events = *events,
                     .notifier = notifier,
                     .file_system = real_file_system(),
                     .signals = &*signals,
                     .runs_loops = runs_loops,
                     .board = &board,
                     .state = &state,
                     .socket = socket,
                     .machines = [&] { return partials.facts(); }});
    know_stations((*sink)->catalog(), service);
    const StatusServer status_server({.socket = socket, .http_port = fixed.status.http_port},
                                     pages_of(board));
    const Caretaker keeper(
        {(*sink)->catalog(), (*sink)->store(), (*sink)->mender(), (*sink)->site_watch()},
        {.refill = fixed.storage.refill},
        {[&] { return service.is_idle(); },
         [&](pipeline::PairReport report) { service.sites_compared(std::move(report)); }});
    service.need([&] { return status_server.answers(); });
    service.watch("status", status_server.pulse());
    service.watch("caretaker", keeper.pulse());
    service.watch("partials", partials.pulse());
    switch (service.run()) {
        case Stopped::cleanly:
            return EXIT_SUCCESS;
        case Stopped::with_jobs:
            // Jobs write files that appear whole or not at all, so ending the process here loses
            // nothing.
            std::_Exit(exit_failed);
    }
    return exit_failed;
}

int run(const ServiceArguments& arguments) {
    const Result<Config> config = load_config(
        *arguments.config, arguments.check && arguments.flag != no_loops ? SceneFiles::must_exist
                                                                         : SceneFiles::as_named);
    if (!config) return complain(program, config.error());
    if (arguments.check) {
        if (arguments.flag == no_loops) {
            // Another process runs the loops.
        } else if (const Status fine =
                       check_loops(config->reloadable.loops, config->fixed.paths.cache);
                   !fine) {
            return complain(
                program, {fine.error().code,
                          fmt::format("{}: {}", arguments.config->native(), fine.error().message)});
        }
        print_notes(*config);
        return say_checked(program, "stormcellar", *arguments.config);
    }
    set_added_stations(config->fixed.ingest.added_stations);
    if (const auto path = config->fixed.ingest.bunzip) bunzip::set_usual_path(*path);
    if (arguments.flag == loops_only) return serve_loops(*config, *arguments.config);
    return serve(*config, *arguments.config, arguments.flag != no_loops);
}

}  // namespace
}  // namespace stormcellar::daemon

int main(int argc, char** argv) {
    using namespace stormcellar::daemon;
    return stormcellar::run_service({program, usage, {no_loops, loops_only}, run}, argc, argv);
}
