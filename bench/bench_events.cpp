// bench_events: the stream of events of stormcellar-web, beside the real stormcellard.
//
// First, real volumes are sent record by record, one file a chunk, on a machine that does nothing
// else; a client hears of the station. A row for each volume:
//   sweeps          those that an event told of
//   latency_*       from the close of a sweep's last chunk to its event at the client
//   bzip2_p50_ms    bunzip alone for those chunks
//   beyond_*        the difference of the two, chunk by chunk
//   end_ms          the same latency for the end of the volume, whose grid is synced
// Then the heaviest national hour (bench/national_feed.h) is played at its own speed, as chunks,
// before as many streams of one station each as --streams says (1,000). A row:
//   asked_per_s     other requests a second beside the streams
//   events_per_s    grids told of; heard_per_s: events that clients read
//   lost            events of a station that one of its clients heard and another did not
//   event_*         from the rename of a grid to its event, at each client
//   web_cores       CPU time of stormcellar-web divided by wall time
//   web_peak_mib    its peak resident memory (VmHWM)
//   grid_*          from the last chunk of a volume to its grid (bench/feed_run.h)
// --sites N: the first N of the 160 sites, each sending as much, for a trial.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/daemon_process.h"
#include "bench/event_clients.h"
#include "bench/feed_run.h"
#include "bench/grid_watch.h"
#include "bench/national_feed.h"
#include "bench/request.h"
#include "bench/sent_volume.h"
#include "bench/table.h"
#include "bench/web_load.h"
#include "stormcellar/cache/grid_name.h"
#include "synth/replay_pieces.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr std::chrono::milliseconds longest_wait{1200};

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

struct ToldSweeps {
    std::vector<double> latency_ms, bzip2_ms, beyond_ms;
    double end_ms = std::nan("");
};

// A daemon and a data server over the same directories.
struct Pair {
    explicit Pair(const fs::path& where) : root(where), daemon(where) {}
    [[nodiscard]] Status start_daemon() { return daemon.start(configuration_for(port)); }
    [[nodiscard]] Result<WebServer> serve() const {
        return serve_configured(root / "stormcellard.toml", port, root);
    }
    fs::path root;
    DaemonProcess daemon;
    int port = free_port();
};

Result<ToldSweeps> send(const SentPieces& volume, const fs::path& root) {
    Pair pair(root);
    const fs::path directory = pair.daemon.drop() / volume.decoded.station;
    std::error_code error;
    fs::create_directories(directory, error);
    if (Status started = pair.start_daemon(); !started) return pass_on(started);
    auto web = pair.serve();
    if (!web) return pass_on(web);
    auto client = EventClients::open(pair.port, {"station=" + volume.decoded.station});
    if (!client) return pass_on(client);
    ToldSweeps told;
    const std::vector<std::size_t> ends = synth::piece_ends(volume.bytes);
    std::size_t begin = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const auto piece = std::span{volume.bytes}.subspan(begin, ends[i] - begin);
        begin = ends[i];
        const bool is_last = i + 1 == ends.size();
        const auto closed = append_piece(directory / chunk_name(volume, i + 1, is_last), piece);
        const auto event = (*client)->wait_for({"sweep_gridded", "volume_complete"}, longest_wait);
        if (!event) continue;
        const double latency_ms = ms_between(closed, event->at);
        if (event->type == "volume_complete") {
            told.end_ms = latency_ms;
            continue;
        }
        const double bzip2_ms = 1000 * bzip2_of(piece);
        told.latency_ms.push_back(latency_ms);
        told.bzip2_ms.push_back(bzip2_ms);
        told.beyond_ms.push_back(latency_ms - bzip2_ms);
    }
    (void)web->process.stop();
    if (!pair.daemon.stop()) return fail(ErrorCode::io, "the daemon did not end well");
    return told;
}

Status measure_volume(const fs::path& path, const fs::path& root, Table& table) {
    const auto volume = read_sent_volume(path);
    if (!volume) return pass_on(volume);
    const auto told = send(*volume, root);
    std::error_code error;
    fs::remove_all(root, error);
    if (!told) return pass_on(told);
    table.add({{"volume", path.filename().string()},
               {"sweeps", static_cast<int>(told->latency_ms.size())},
               {"latency_p50_ms", Cell{quantile(told->latency_ms, 0.5), 1}},
               {"latency_max_ms", Cell{quantile(told->latency_ms, 1), 1}},
               {"bzip2_p50_ms", Cell{quantile(told->bzip2_ms, 0.5), 1}},
               {"beyond_p50_ms", Cell{quantile(told->beyond_ms, 0.5), 1}},
               {"beyond_p95_ms", Cell{quantile(told->beyond_ms, 0.95), 1}},
               {"beyond_max_ms", Cell{quantile(told->beyond_ms, 1), 1}},
               {"end_ms", Cell{told->end_ms, 1}}});
    return {};
}

// Notes when grids get their names, on a thread of its own.
class RenameClock {
  public:
    [[nodiscard]] Status start(const fs::path& cache, const NationalFeed& feed) {
        std::vector<std::string> stations;
        for (const NationalSite& site : feed.sites())
            stations.emplace_back(site.station.icao);
        const std::vector<std::string> days = {cache::day_name(national_start()),
                                               cache::day_name(national_start() - 24h)};
        if (Status watched = watch_.watch(cache, stations, days); !watched) return watched;
        thread_ = std::thread([this] {
            while (!is_stopping_) {
                watch_.wait(0.05);
                watch_.read([&](std::string_view file) {
                    times_[std::string(file)].push_back(Clock::now());
                });
            }
        });
        return {};
    }
    void stop() {
        is_stopping_ = true;
        if (thread_.joinable()) thread_.join();
    }
    ~RenameClock() { stop(); }
    // The rename that is nearest to an event; call it after stop().
    [[nodiscard]] std::optional<Clock::time_point> nearest(const std::string& file,
                                                           Clock::time_point at) const {
        const auto times = times_.find(file);
        if (times == times_.end()) return std::nullopt;
        return *std::min_element(
            times->second.begin(), times->second.end(), [&](const auto& one, const auto& other) {
                return std::abs(ms_between(one, at)) < std::abs(ms_between(other, at));
            });
    }
    [[nodiscard]] std::size_t renames_after(Clock::time_point begin) const {
        std::size_t count = 0;
        for (const auto& [file, times] : times_)
            count += static_cast<std::size_t>(
                std::count_if(times.begin(), times.end(), [&](auto at) { return at >= begin; }));
        return count;
    }

  private:
    GridWatch watch_;
    std::atomic<bool> is_stopping_ = false;
    std::map<std::string, std::vector<Clock::time_point>> times_;  // the thread's until stop()
    std::thread thread_;
};

// Asks so often a second, for lists, packed grids and metrics in turn, one after another.
class OtherRequests {
  public:
    OtherRequests(WebServer& server, const NationalFeed& feed, int a_second, fs::path scratch) {
        if (a_second <= 0) return;
        thread_ = std::thread(
            [this, address = server.address(), &feed, a_second, scratch = std::move(scratch)] {
                auto next = Clock::now();
                for (std::size_t i = 0; !is_stopping_; ++i) {
                    const auto& site = feed.sites()[i % feed.sites().size()];
                    const std::vector<std::string> paths = {
                        "/api/v1/stations",
                        fmt::format("/api/v1/grids/{}/REF/latest/packed", site.station.icao),
                        fmt::format("/volumes/{}/?limit=5", site.station.icao), "/metrics"};
                    const auto got =
                        get(address + paths[i % paths.size()], {"Accept-Encoding: gzip"}, scratch);
                    if (!got || got->status != 200) {
                        ++failed;
                        fmt::print(stderr, "{}: {}\n", paths[i % paths.size()],
                                   got ? std::to_string(got->status) : got.error().message);
                    }
                    ++asked;
                    next += std::chrono::microseconds{1'000'000 / a_second};
                    std::this_thread::sleep_until(next);
                }
            });
    }
    ~OtherRequests() { stop(); }
    void stop() {
        is_stopping_ = true;
        if (thread_.joinable()) thread_.join();
    }
    std::atomic<int> asked = 0, failed = 0;

  private:
    std::atomic<bool> is_stopping_ = false;
    std::thread thread_;
};

struct Heard {
    std::vector<double> event_ms;
    std::size_t heard = 0, told = 0, lost = 0;
};

// Every client of a station hears the same grids; what one of them lacks is lost.
Heard compare(const std::vector<HeardEvent>& events, const RenameClock& renames,
              const std::vector<std::string>& stations, std::size_t clients) {
    Heard result;
    std::map<std::string, std::vector<std::size_t>> counts;  // by station, of each client
    for (std::size_t i = 0; i < clients; ++i)
        counts[stations[i % stations.size()]].resize(clients);
    for (const HeardEvent& event : events) {
        if (event.grid.empty()) continue;
        ++result.heard;
        ++counts[event.station][event.client];
        const auto time = parse_utc(event.grid, UtcTime{});
        if (!time) continue;
        const cache::GridName name{event.station, level2::Moment::ref, *time};
        const auto renamed = renames.nearest(cache::relative_path(name).filename(), event.at);
        if (renamed) result.event_ms.push_back(std::max(ms_between(*renamed, event.at), 0.0));
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
    int asked_per_s = 0;
    double seconds = 60;
};

Status measure_streams(const NationalFeed& feed, const Wanted& wanted, const fs::path& root,
                       Table& table) {
    Pair pair(root);
    FeedRun run(feed, pair.daemon, Delivery::chunks);
    if (Status sent = run.send_beginnings(); !sent) return sent;
    if (Status watched = run.watch(feed); !watched) return watched;
    RenameClock renames;
    if (Status watched = renames.start(pair.daemon.cache(), feed); !watched) return watched;
    if (Status started = pair.start_daemon(); !started) return started;
    if (!run.drain(120)) fmt::print(stderr, "not all of the beginnings were read\n");
    auto web = pair.serve();
    if (!web) return pass_on(web);
    std::vector<std::string> stations, queries;
    for (const NationalSite& site : feed.sites())
        stations.emplace_back(site.station.icao);
    const auto streams = static_cast<std::size_t>(wanted.streams);
    for (std::size_t i = 0; i < streams; ++i)
        queries.push_back("station=" + stations[i % stations.size()]);
    auto clients = EventClients::open(pair.port, queries);
    if (!clients) return pass_on(clients);
    (void)(*clients)->take();
    OtherRequests others(*web, feed, wanted.asked_per_s, root);
    const double cpu_before_s = web->process.cpu_s();
    const auto begin = Clock::now();
    StretchOptions options;
    options.most_wall_s = wanted.seconds;
    const auto stretch = run.run(options);
    if (!stretch) return pass_on(stretch);
    std::this_thread::sleep_for(200ms);
    const double wall_s = ms_between(begin, Clock::now()) / 1000;
    const double cpu_s = web->process.cpu_s() - cpu_before_s;
    others.stop();
    renames.stop();
    const Heard heard = compare((*clients)->take(), renames, stations, streams);
    table.add({{"streams", wanted.streams},
               {"asked_per_s", Cell{others.asked / wall_s, 1}},
               {"failed", others.failed.load()},
               {"seconds", Cell{wall_s, 0}},
               {"grids_per_s", Cell{static_cast<double>(renames.renames_after(begin)) / wall_s, 1}},
               {"events_per_s", Cell{static_cast<double>(heard.told) / wall_s, 1}},
               {"heard_per_s", Cell{static_cast<double>(heard.heard) / wall_s, 1}},
               {"lost", static_cast<int>(heard.lost)},
               {"closed", static_cast<int>((*clients)->closed())},
               {"event_p50_ms", Cell{quantile(heard.event_ms, 0.5), 1}},
               {"event_p95_ms", Cell{quantile(heard.event_ms, 0.95), 1}},
               {"event_max_ms", Cell{quantile(heard.event_ms, 1), 1}},
               {"web_cores", Cell{cpu_s / wall_s, 3}},
               {"web_peak_mib", Cell{web->process.peak_mib(), 0}},
               {"daemon_cores", Cell{stretch->daemon_cpu_s / stretch->wall_s, 2}},
               {"grid_p50_s", Cell{stretch->latency_s(0.5), 3}},
               {"grid_p95_s", Cell{stretch->latency_s(0.95), 3}}});
    (void)web->process.stop();
    if (!pair.daemon.stop()) return fail(ErrorCode::io, "the daemon did not end well");
    return {};
}

Status measure_hour(const Request& request, const Wanted& wanted, const fs::path& work,
                    Table& table) {
    const auto feed = NationalFeed::make(wanted.sites, 1, request.data_directory(), work / "feed",
                                         request.threads.back());
    if (!feed) return pass_on(feed);
    std::set<int> rates = {0, wanted.asked_per_s};
    for (const int rate : rates) {
        const fs::path root = work / fmt::format("events-{}", ::getpid());
        Wanted one = wanted;
        one.asked_per_s = rate;
        const Status measured = measure_streams(*feed, one, root, table);
        std::error_code error;
        fs::remove_all(root, error);
        if (!measured) return measured;
    }
    return {};
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
    wanted.asked_per_s = std::atoi(request.value("--asked").value_or("10").c_str());
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
    if (status) return 0;
    fmt::print(stderr, "bench_events: {}\n", status.error().message);
    return status.error().code == ErrorCode::not_found ? 3 : 1;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    namespace bench = stormcellar::bench;
    const bench::Program program{
        .name = "bench_events",
        .files = "[FILE ...]",
        .purpose =
            "events of the data server: latency of sweeps, and many streams at the heaviest\n"
            "national hour; --streams N, --asked REQUESTS_A_SECOND, --seconds N, --sites N,\n"
            "--work DIR",
        .flags = {"--sweeps", "--hour"},
        .values = {"--streams", "--asked", "--seconds", "--sites", "--work"}};
    const auto read = bench::read_request(program, std::span(argv, static_cast<std::size_t>(argc)));
    return read.request ? bench::run(*read.request) : read.status;
}
