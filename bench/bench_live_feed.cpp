// bench_live_feed: measures how soon stormcellar-feed fetches chunks from a bucket on the loopback.
//
// usage: bench_live_feed [--data DIR] [--work DIR] [--json]      (bench/request.h)
// Real chunks become visible in the bucket one after another, at times that are independent of the
// feed's polls. The real stormcellard grids the chunks that the feed writes. There is a row for
// each set of chunks:
//   file_*   time from the chunk's appearance in the bucket to its appearance in the drop directory
//   grid_*   time from the chunk's appearance in the bucket to the living grid in the cache, for
//            chunks that complete a sweep
//   beyond_* grid_* less the polling interval; the promise is at most one second at p95
#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/grid_watch.h"
#include "bench/measure.h"
#include "bench/process.h"
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

double seconds_from(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Starts the feed. `drop` is a name below `root`. If a daemon runs, `root` is the daemon's root.
Result<ChildProcess> start_feed(const fs::path& root, const ChunkBucket& bucket,
                                const std::vector<std::string>& stations) {
    std::error_code failed;
    fs::create_directories(root, failed);
    std::ofstream(root / "feed.toml") << fmt::format(
        "[paths]\ndrop = \"drop\"\n[feed]\nstations = [\"{}\"]\nbucket = \"{}\"\n"
        "drop = \"drop\"\nstate = \"feed\"\nevery_seconds = {}\n",
        fmt::join(stations, "\", \""), bucket.url(), every_s);
    return ChildProcess::start(
        {built_program("feed/stormcellar-feed"), "--config", root / "feed.toml"},
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

// Makes a chunk visible in the bucket, waits for the results, and then waits `rest_s` more.
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

int run(int argc, char** argv) {
    const auto read = read_request(
        {"bench_live_feed", "", "from visible in a bucket to the grid", {}, {"--work"}},
        std::span(argv, static_cast<std::size_t>(argc)));
    if (!read.request) return read.status;
    const fs::path root =
        fs::path{read.request->value("--work").value_or(fs::temp_directory_path().string())} /
        fmt::format("bench-live-feed-{}", ::getpid());
    return measure_latency(*read.request, root);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
