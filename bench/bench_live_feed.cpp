// bench_live_feed: measures stormcellar-feed with a bucket on the loopback.
//
// latency (default): real chunks become visible in the bucket one after another, at times that have
//   nothing to do with the feed's, and the real stormcellard grids what the feed writes.
//     file_*   from visible in the bucket to the chunk in the drop directory
//     grid_*   from visible to the living grid in the cache, of the chunks that complete a sweep
//     beyond_* the same less the polling interval; the promise is one second at most at p95
// --stations N: one process follows N made stations, each with a chunk of 120 kB every 5 seconds.
//     file_*   as above
//     peak_mb, processor   of the feed: memory, and seconds of a processor a second
//     listings_*  requests for lists of a station a minute, while it sends and then while it is
//     idle
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/child_process.h"
#include "bench/daemon_process.h"
#include "bench/grid_watch.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/cache/grid_name.h"
#include "tests/fetch/feed/chunk_bucket.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using feed::ChunkBucket;

constexpr double every_s = 4, longest_wait_s = 12, settle_s = 1.2;
constexpr std::size_t made_chunk_bytes = 120'000;
constexpr std::chrono::seconds between_chunks{5};

double seconds_from(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// `drop` is a name below the root, which is that of the daemon, if there is one.
Result<ChildProcess> start_feed(const fs::path& root, const ChunkBucket& bucket,
                                const std::vector<std::string>& stations) {
    std::error_code failed;
    fs::create_directories(root, failed);
    std::ofstream(root / "feed.toml") << fmt::format(
        "[paths]\ndrop = \"drop\"\n[feed]\nstations = [\"{}\"]\nbucket = \"{}\"\n"
        "drop = \"drop\"\nstate = \"feed\"\nevery_seconds = {}\n",
        fmt::join(stations, "\", \""), bucket.url(), every_s);
    const fs::path own = fs::read_symlink("/proc/self/exe", failed);
    const fs::path program = own.parent_path().parent_path() / "feed" / "stormcellar-feed";
    return ChildProcess::start({program.native(), "--config", (root / "feed.toml").native()},
                               root / "feed.out");
}

struct Latencies {
    std::vector<double> file_s, grid_s;
};

void add_latencies(Row& row, const std::string& name, const std::vector<double>& seconds) {
    row.emplace_back(name + "_p50_s", Cell{quantile(seconds, 0.5), 2});
    row.emplace_back(name + "_p95_s", Cell{quantile(seconds, 0.95), 2});
    row.emplace_back(name + "_max_s", Cell{quantile(seconds, 1), 2});
}

// Makes a chunk visible and watches what becomes of it, for `rest_s` longer than that may take.
void play(ChunkBucket& bucket, const std::string& key, const std::string& contents,
          const fs::path& drop, const GridWatch& watch, double rest_s, Latencies& latencies) {
    const auto visible = Clock::now();
    bucket.put(key, contents);
    std::optional<double> file_s, grid_s;
    while (seconds_from(visible) < file_s.value_or(longest_wait_s) + settle_s + rest_s) {
        watch.wait(0.005);
        if (!file_s && fs::exists(drop / key)) file_s = seconds_from(visible);
        watch.read([&](std::string_view) {
            if (!grid_s) grid_s = seconds_from(visible);
        });
    }
    if (file_s) latencies.file_s.push_back(*file_s);
    if (grid_s) latencies.grid_s.push_back(*grid_s);
}

Result<Latencies> measure_set(const fs::path& set, const std::string& station,
                              const fs::path& root) {
    const auto chunks = feed::files_below(set);
    if (chunks.empty()) return fail(ErrorCode::not_found, "{}: no chunks", set.native());
    const std::string first = chunks.begin()->first;
    const std::string day = first.substr(0, 8);
    DaemonProcess daemon(root);
    GridWatch watch;
    const std::vector<std::string> stations = {station};
    const std::vector<std::string> days = {cache::day_name(*parse_utc(
        fmt::format("{}-{}-{}", day.substr(0, 4), day.substr(4, 2), day.substr(6, 2)), {}))};
    if (Status watched = watch.watch(daemon.cache(), stations, days); !watched)
        return pass_on(watched);
    if (Status started = daemon.start("[cache]\nbytes = \"1 GiB\"\n[log]\nlevel = \"warning\"\n");
        !started)
        return pass_on(started);
    ChunkBucket bucket;
    bucket.put(station + "/7/" + first, chunks.begin()->second);
    auto process = start_feed(root, bucket, stations);
    if (!process) return pass_on(process);
    while (!fs::exists(daemon.drop() / station / "7" / first) && process->is_running())
        std::this_thread::sleep_for(std::chrono::milliseconds{10});
    Latencies latencies;
    std::mt19937 chance(1);
    std::uniform_real_distribution<double> wait(0, every_s);
    for (auto one = std::next(chunks.begin()); one != chunks.end(); ++one)
        play(bucket, station + "/7/" + one->first, one->second, daemon.drop(), watch, wait(chance),
             latencies);
    if (!process->stop() || !daemon.stop())
        return fail(ErrorCode::io, "a program did not end well");
    return latencies;
}

int measure_latency(const Request& request, const fs::path& root) {
    Table table(request.json);
    for (const auto& [set, station] :
         {std::pair{"OPENRADAR_KLOT", "KLOT"}, std::pair{"L2D_185", "TORD"},
          std::pair{"L2D_230", "KLOT"}}) {
        const auto latencies =
            measure_set(request.data_directory() / "chunks" / set, station, root);
        std::error_code ignored;
        fs::remove_all(root, ignored);
        if (!latencies) {
            fmt::print(stderr, "bench_live_feed: {}\n", latencies.error().message);
            return 1;
        }
        Row row = {{"set", set}, {"chunks", static_cast<int>(latencies->file_s.size())}};
        add_latencies(row, "file", latencies->file_s);
        row.emplace_back("sweeps", static_cast<int>(latencies->grid_s.size()));
        add_latencies(row, "grid", latencies->grid_s);
        row.emplace_back("beyond_p95_s", Cell{quantile(latencies->grid_s, 0.95) - every_s, 2});
        table.add(std::move(row));
    }
    table.finish();
    return 0;
}

std::vector<std::string> made_stations(int count) {
    std::vector<std::string> stations;
    for (int i = 0; i < count; ++i)
        stations.push_back(fmt::format("K{:03}", i));
    return stations;
}

// Each station sends a chunk every five seconds, at a time of its own.
class MadeStations {
  public:
    explicit MadeStations(int count) : stations_(made_stations(count)) {
        bucket.change = [](const std::string& asked, pull::Reply reply) {
            if (asked.starts_with("GET")) reply.body.assign(made_chunk_bytes, 'x');
            return reply;
        };
        for (const std::string& station : stations_)
            for (int number = 1; number <= 2; ++number)
                put(station, number);
    }
    [[nodiscard]] const std::vector<std::string>& stations() const { return stations_; }
    // Sends for so long. Returns the seconds from visible to the file, of each chunk that came.
    std::vector<double> send(std::chrono::seconds time, const fs::path& drop) {
        const auto start = Clock::now();
        std::vector<std::pair<std::string, Clock::time_point>> visible;
        std::vector<double> came_s;
        const auto step = between_chunks / static_cast<double>(stations_.size());
        int number = 2;
        for (std::size_t sent = 0; Clock::now() - start < time; ++sent) {
            const std::size_t station = sent % stations_.size();
            number += station == 0 ? 1 : 0;
            visible.emplace_back(put(stations_[station], number), Clock::now());
            std::this_thread::sleep_until(start + static_cast<double>(sent + 1) * step);
            std::erase_if(visible, [&](const auto& one) {
                const bool has_come = fs::exists(drop / one.first);
                if (has_come) came_s.push_back(seconds_from(one.second));
                return has_come;
            });
        }
        return came_s;
    }
    ChunkBucket bucket;

  private:
    std::string put(const std::string& station, int number) {
        const std::string key = feed::key_of(station, 7, start_, number, number == 1 ? 'S' : 'I');
        bucket.put(key, "");
        bucket.say_size(key, made_chunk_bytes);
        return key;
    }
    std::vector<std::string> stations_;
    UtcTime start_ = std::chrono::floor<std::chrono::seconds>(now_utc());
};

int measure_stations(int count, const Request& request, const fs::path& root) {
    MadeStations made(count);
    auto process = start_feed(root, made.bucket, made.stations());
    if (!process) return 1;
    std::this_thread::sleep_for(std::chrono::seconds{10});
    const double minutes = request.runs;
    const auto sending = std::chrono::seconds{60 * request.runs};
    const double cpu_s = process->cpu_s();
    const std::size_t before = made.bucket.count("LIST");
    const std::vector<double> came_s = made.send(sending, root / "drop");
    const double busy = (process->cpu_s() - cpu_s) / static_cast<double>(sending.count());
    const auto listings = static_cast<double>(made.bucket.count("LIST") - before) / minutes / count;
    std::this_thread::sleep_for(std::chrono::seconds{10});
    const std::size_t then = made.bucket.count("LIST");
    std::this_thread::sleep_for(std::chrono::seconds{60});
    Table table(request.json);
    Row row = {{"stations", count}, {"chunks", static_cast<int>(came_s.size())}};
    add_latencies(row, "file", came_s);
    row.emplace_back("peak_mb", Cell{process->peak_mib() * 1.048576, 1});
    row.emplace_back("processor", Cell{busy, 3});
    row.emplace_back("listings_sending", Cell{listings, 1});
    row.emplace_back("listings_idle",
                     Cell{static_cast<double>(made.bucket.count("LIST") - then) / count, 1});
    table.add(std::move(row));
    table.finish();
    const bool ended = process->stop();
    std::error_code ignored;
    fs::remove_all(root, ignored);
    return ended ? 0 : 1;
}

int run(int argc, char** argv) {
    const auto read = read_request(
        {"bench_live_feed",
         "",
         "from visible in a bucket to the grid; --stations N for many stations; --work DIR",
         {},
         {"--stations", "--work"}},
        std::span(argv, static_cast<std::size_t>(argc)));
    if (!read.request) return read.status;
    const fs::path root =
        fs::path{read.request->value("--work").value_or(fs::temp_directory_path().string())} /
        fmt::format("bench-live-feed-{}", ::getpid());
    const auto stations = read.request->value("--stations");
    return stations ? measure_stations(std::stoi(*stations), *read.request, root)
                    : measure_latency(*read.request, root);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
