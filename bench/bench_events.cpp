// bench_events: measures how soon data become grids of stormcellard and events of stormcellar-web.
//
// usage: bench_events [--data DIR] [--work DIR] [--sweeps | --hour] [--streams N]
//        [--seconds N] [--sites N] [--json] [FILE ...]      (bench/request.h)
// --sweeps: Sends three real volumes, or the named files, record by record, on a machine that
// should do nothing else. A client reads the events of the station. There is a row for each volume
// and way of sending:
//   as              way of sending. growing: each record is appended to one file, which is closed
//                   each time. chunks: each record becomes a file
//   sweeps          number of sweeps that had an event
//   grid_*_ms       time from the close of a sweep's last chunk to the rename of its grid
//   event_*_ms      time from the close of a sweep's last chunk to the sweep's event at the client
//   bzip2_p50_ms    median of the times that bunzip alone takes for the last chunks of sweeps
//   *_beyond_*      the times of grid_* and event_*, less bunzip's time for the sweep's last chunk
//   end_ms          time from the volume's last chunk to the grid of the whole volume, synced
//   end_event_ms    time from the volume's last chunk to the event of that grid
// --hour: Plays the heaviest national hour (bench/national_feed.h) as chunks at its own speed,
// while --streams N (1,000) clients each read the events of one station. There is one row:
//   grids_per_s     renames of grids a second
//   events_per_s    grids with an event a second
//   heard_per_s     events a second that all clients together read
//   lost            number of events that a client missed and another client of the station read
//   closed          number of streams that ended
//   event_*         time from the rename of a grid to its event, at each client
//   web_cores       CPU time of stormcellar-web divided by wall time
//   web_peak_mib    peak resident memory of stormcellar-web (VmHWM)
//   grid_*          time from the last chunk of a volume to its grid (bench/feed_run.h)
// --sites N: uses only the first N of the 160 sites, for a trial. Without --sweeps and --hour, both
// are run.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/event_clients.h"
#include "bench/feed_run.h"
#include "bench/grid_watch.h"
#include "bench/measure.h"
#include "bench/national_feed.h"
#include "bench/process.h"
#include "bench/request.h"
#include "bench/table.h"
#include "bench/web_load.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_name.h"
#include "stormcellar/level2/chunk_name.h"
#include "stormcellar/level2/decode.h"
#include "synth/replay_pieces.h"
#include "tests/testing/loopback.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr double longest_wait_ms = 1200;

std::string configuration_for(int port) {
    return fmt::format(
        "[cache]\nbytes = \"2 GiB\"\n[ingest]\nspacing_km = 1.0\nextent_km = [460, 460]\n"
        "levels_km = \"0.5:16:0.5\"\n[log]\nlevel = \"warning\"\n"
        "[web]\nlisten = [\"127.0.0.1:{}\"]\n"
        "[web.limits]\nevent_streams = 10000\nevent_streams_of_a_client = 10000\n",
        port);
}

double ms_between(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
}

// A daemon and a data server that use the same directories.
struct Pair {
    explicit Pair(const fs::path& where) : root(where), daemon(where) {}
    [[nodiscard]] Result<WebServer> serve() const {
        return serve_configured(root / "stormcellard.toml", port, root);
    }
    fs::path root;
    DaemonProcess daemon;
    int port = testing::free_port();
};

// A real volume with LDM records.
struct SentVolume {
    fs::path path;
    Bytes bytes;
    std::string station;
    UtcTime time;

    // Returns the name of the file that receives the piece with this number, counted from 1.
    [[nodiscard]] fs::path file_of(std::size_t number, bool is_last, bool as_chunks) const {
        if (!as_chunks) return path.filename();
        level2::ChunkName name;
        name.volume = format_compact(time);
        name.volume[8] = '-';
        name.number = static_cast<int>(number);
        if (is_last) name.kind = level2::ChunkKind::end;
        if (number == 1) name.kind = level2::ChunkKind::start;
        return to_string(name);
    }
};

Result<SentVolume> read_volume(const fs::path& path) {
    auto bytes = read_file(path);
    if (!bytes) return pass_on(bytes);
    const auto decoded = level2::decode(*bytes);
    if (!decoded) return pass_on(decoded);
    if (!decoded->volume.header || !synth::has_ldm_records(*bytes))
        return fail(ErrorCode::unsupported, "{}: no LDM records", path.native());
    return SentVolume{path, std::move(*bytes), decoded->volume.station,
                      decoded->volume.header->time()};
}

// Appends the bytes. Returns the time just before the close.
Clock::time_point append(const fs::path& path, std::span<const std::byte> bytes) {
    std::ofstream file(path, std::ios::binary | std::ios::app);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    file.flush();
    return Clock::now();
}

double bunzip_ms(std::span<const std::byte> piece) {
    const Bytes bytes(piece.begin(), piece.end());
    Bytes peeled;
    const auto records = ldm_records(bytes, peeled);
    double least_s = 1e9;
    for (int run = 0; run < 3; ++run)
        keep_least_seconds(least_s, [&] { bunzip_all(records); });
    return 1000 * least_s;
}

// The times of the grid and of the event that followed a piece.
struct Told {
    std::optional<double> grid_ms, event_ms;
    bool is_complete = false;
};

Told wait_for_both(const GridWatch& watch, EventClients& client, Clock::time_point closed) {
    Told told;
    while (!(told.grid_ms && told.event_ms) && ms_between(closed, Clock::now()) < longest_wait_ms) {
        watch.wait(0.005);
        watch.read([&](std::string_view) {
            if (!told.grid_ms) told.grid_ms = ms_between(closed, Clock::now());
        });
        for (const HeardEvent& event : client.take()) {
            if (event.type != "sweep_gridded" && event.type != "volume_complete") continue;
            if (!told.event_ms) told.event_ms = ms_between(closed, event.at);
            told.is_complete = event.type == "volume_complete";
        }
    }
    return told;
}

struct Sweeps {
    std::vector<double> grid_ms, event_ms, bzip2_ms, grid_beyond_ms, event_beyond_ms;
    double end_ms = std::nan(""), end_event_ms = std::nan("");
};

Result<Sweeps> send(const SentVolume& volume, bool as_chunks, const fs::path& root) {
    Pair pair(root);
    const fs::path directory = pair.daemon.drop() / volume.station;
    std::error_code error;
    fs::create_directories(directory, error);
    GridWatch watch;
    const std::vector<std::string> stations = {volume.station};
    const std::vector<std::string> days = {cache::day_name(volume.time)};
    if (Status watched = watch.watch(pair.daemon.cache(), stations, days); !watched)
        return pass_on(watched);
    if (Status started = pair.daemon.start(configuration_for(pair.port)); !started)
        return pass_on(started);
    auto web = pair.serve();
    if (!web) return pass_on(web);
    auto client = EventClients::open(pair.port, {"station=" + volume.station});
    if (!client) return pass_on(client);
    Sweeps sweeps;
    const std::vector<std::size_t> ends = synth::piece_ends(volume.bytes);
    std::size_t begin = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const auto piece = std::span{volume.bytes}.subspan(begin, ends[i] - begin);
        begin = ends[i];
        const auto closed =
            append(directory / volume.file_of(i + 1, i + 1 == ends.size(), as_chunks), piece);
        const Told told = wait_for_both(watch, **client, closed);
        if (!told.event_ms || !told.grid_ms) continue;
        if (told.is_complete) {
            sweeps.end_ms = *told.grid_ms;
            sweeps.end_event_ms = *told.event_ms;
            continue;
        }
        const double bzip2_ms = bunzip_ms(piece);
        sweeps.grid_ms.push_back(*told.grid_ms);
        sweeps.event_ms.push_back(*told.event_ms);
        sweeps.bzip2_ms.push_back(bzip2_ms);
        sweeps.grid_beyond_ms.push_back(*told.grid_ms - bzip2_ms);
        sweeps.event_beyond_ms.push_back(*told.event_ms - bzip2_ms);
    }
    (void)web->process.stop();
    if (!pair.daemon.stop()) return fail(ErrorCode::io, "the daemon did not end well");
    return sweeps;
}

Status measure_volume(const fs::path& path, const fs::path& root, Table& table) {
    const auto volume = read_volume(path);
    if (!volume) return pass_on(volume);
    for (const bool as_chunks : {false, true}) {
        const auto sweeps = send(*volume, as_chunks, root);
        std::error_code error;
        fs::remove_all(root, error);
        if (!sweeps) return pass_on(sweeps);
        Row row = {{"volume", path.filename().string()},
                   {"as", as_chunks ? "chunks" : "growing"},
                   {"sweeps", static_cast<int>(sweeps->event_ms.size())}};
        const auto add = [&](const std::string& name, const std::vector<double>& ms) {
            for (const auto& [share, label] : {std::pair{0.5, "p50"}, {0.95, "p95"}, {1.0, "max"}})
                row.emplace_back(name + label + "_ms", Cell{quantile(ms, share), 1});
        };
        add("grid_", sweeps->grid_ms);
        add("event_", sweeps->event_ms);
        row.emplace_back("bzip2_p50_ms", Cell{quantile(sweeps->bzip2_ms, 0.5), 1});
        add("grid_beyond_", sweeps->grid_beyond_ms);
        add("event_beyond_", sweeps->event_beyond_ms);
        row.emplace_back("end_ms", Cell{sweeps->end_ms, 1});
        row.emplace_back("end_event_ms", Cell{sweeps->end_event_ms, 1});
        table.add(std::move(row));
    }
    return {};
}

struct Heard {
    std::vector<double> event_ms;
    std::size_t heard = 0, told = 0, lost = 0;
};

// Compares the clients. All clients of a station should read the same events. An event is lost for
// a client if other clients of the station read it and this client did not.
Heard compare(const std::vector<HeardEvent>& events, const Renames& renames,
              const std::vector<std::string>& stations, std::size_t clients) {
    Heard result;
    std::map<std::string, std::vector<std::size_t>> counts;  // by station; events of each client
    for (std::size_t i = 0; i < clients; ++i)
        counts[stations[i % stations.size()]].resize(clients);
    for (const HeardEvent& event : events) {
        if (event.grid.empty()) continue;
        ++result.heard;
        ++counts[event.station][event.client];
        const auto time = parse_utc(event.grid, UtcTime{});
        if (!time) continue;
        const cache::GridName name{event.station, level2::Moment::ref, *time};
        const auto renamed = renames.find(cache::relative_path(name).filename());
        if (renamed == renames.end()) continue;
        double nearest_ms = HUGE_VAL;  // time from the nearest rename of the grid
        for (const Clock::time_point at : renamed->second) {
            if (std::abs(ms_between(at, event.at)) < std::abs(nearest_ms))
                nearest_ms = ms_between(at, event.at);
        }
        result.event_ms.push_back(std::max(nearest_ms, 0.0));
    }
    for (std::size_t i = 0; i < clients; ++i) {
        const auto& of_station = counts[stations[i % stations.size()]];
        const std::size_t most = *std::max_element(of_station.begin(), of_station.end());
        result.lost += most - of_station[i];
        if (i < stations.size()) result.told += most;
    }
    return result;
}

struct Wanted {
    int streams = 1000;
    int sites = national_sites;
    double seconds = 60;
};

Status measure_streams(const NationalFeed& feed, const Wanted& wanted, const fs::path& root,
                       Table& table) {
    Pair pair(root);
    std::vector<std::string> stations, queries;
    for (const NationalSite& site : feed.sites())
        stations.emplace_back(site.station.icao);
    const auto streams = static_cast<std::size_t>(wanted.streams);
    for (std::size_t i = 0; i < streams; ++i)
        queries.push_back("station=" + stations[i % stations.size()]);
    std::optional<WebServer> web;
    std::unique_ptr<EventClients> clients;
    double cpu_before_s = 0;
    Clock::time_point begin;
    const auto open = [&]() -> Status {
        auto served = pair.serve();
        if (!served) return pass_on(served);
        web.emplace(std::move(*served));
        auto opened = EventClients::open(pair.port, queries);
        if (!opened) return pass_on(opened);
        clients = std::move(*opened);
        (void)clients->take();
        cpu_before_s = web->process.cpu_s();
        begin = Clock::now();
        return {};
    };
    StretchOptions options;
    options.delivery = synth::Delivery::chunks;
    options.most_wall_s = wanted.seconds;
    FeedRun run(feed, pair.daemon);
    const auto stretch = run.run(options, configuration_for(pair.port), open);
    if (!stretch) return pass_on(stretch);
    const double wall_s = ms_between(begin, Clock::now()) / 1000;
    const double cpu_s = web->process.cpu_s() - cpu_before_s;
    std::size_t renames = 0;
    for (const auto& [grid, times] : run.renames())
        renames += times.size();
    const Heard heard = compare(clients->take(), run.renames(), stations, streams);
    table.add({{"streams", wanted.streams},
               {"seconds", Cell{wall_s, 0}},
               {"grids_per_s", Cell{static_cast<double>(renames) / wall_s, 1}},
               {"events_per_s", Cell{static_cast<double>(heard.told) / wall_s, 1}},
               {"heard_per_s", Cell{static_cast<double>(heard.heard) / wall_s, 1}},
               {"lost", static_cast<int>(heard.lost)},
               {"closed", static_cast<int>(clients->closed())},
               {"event_p50_ms", Cell{quantile(heard.event_ms, 0.5), 1}},
               {"event_p95_ms", Cell{quantile(heard.event_ms, 0.95), 1}},
               {"event_max_ms", Cell{quantile(heard.event_ms, 1), 1}},
               {"web_cores", Cell{cpu_s / wall_s, 3}},
               {"web_peak_mib", Cell{web->process.memory_mib(), 0}},
               {"daemon_cores", Cell{stretch->daemon_cpu_s / stretch->wall_s, 2}},
               {"grid_p50_s", Cell{quantile(stretch->latencies_s, 0.5), 3}},
               {"grid_p95_s", Cell{quantile(stretch->latencies_s, 0.95), 3}}});
    (void)web->process.stop();
    if (!pair.daemon.stop()) return fail(ErrorCode::io, "the daemon did not end well");
    return {};
}

Status measure_hour(const Request& request, const Wanted& wanted, const fs::path& work,
                    Table& table) {
    const auto feed = NationalFeed::make(wanted.sites, 1, request.data_directory(), work / "feed",
                                         request.threads.back());
    if (!feed) return pass_on(feed);
    const fs::path root = work / fmt::format("events-{}", ::getpid());
    Status measured = measure_streams(*feed, wanted, root, table);
    std::error_code error;
    fs::remove_all(root, error);
    return measured;
}

std::vector<fs::path> files_of(const Request& request) {
    if (!request.files.empty()) return request.files;
    std::vector<fs::path> files;
    for (const fs::path& file : request.volumes())
        for (const char* busy : {"KLBB20160601", "KLOT20220317", "KDMX20250101"})
            if (file.filename().native().starts_with(busy)) files.push_back(file);
    return files;
}

int run(const Request& request) {
    const fs::path work = fs::absolute(request.value("--work").value_or(
        (fs::temp_directory_path() / "stormcellar-bench-feed").string()));
    Wanted wanted;
    wanted.streams = std::atoi(request.value("--streams").value_or("1000").c_str());
    wanted.seconds = std::atof(request.value("--seconds").value_or("60").c_str());
    wanted.sites =
        std::atoi(request.value("--sites").value_or(std::to_string(national_sites)).c_str());
    if (wanted.streams < 1 || wanted.streams > 10'000 || wanted.seconds < 1 || wanted.sites < 1 ||
        wanted.sites > national_sites) {
        fmt::print(stderr,
                   "bench_events: --streams 1 to 10000, --seconds at least 1, --sites 1 to {}\n",
                   national_sites);
        return 2;
    }
    Table table(request.json);
    Status status;
    for (const fs::path& file : files_of(request)) {
        if (status && !request.has("--hour"))
            status = measure_volume(file, work / fmt::format("sweeps-{}", ::getpid()), table);
    }
    if (status && !request.has("--sweeps")) status = measure_hour(request, wanted, work, table);
    table.finish();
    return exit_status("bench_events", status);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run_benchmark(
        {"bench_events",
         "[FILE ...]",
         "how soon grids and events of the data server follow: --sweeps, one by one;\n"
         "--hour, many --streams at the heaviest national hour",
         {"--sweeps", "--hour"},
         {"--streams", "--seconds", "--sites", "--work"}},
        argc, argv, stormcellar::bench::run);
}
