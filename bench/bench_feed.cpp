// bench_feed: plays the heaviest national hour of Level II to the real stormcellard.
//
// A national feed (bench/national_feed.h) is made once, untimed, below --work. Then the daemon that
// was built with this program is started with its own directories there, gridding every volume at 1
// km and 32 levels. What every site has already sent of its current volume is there from the start.
// The feed is played at each speed in turn to the same daemon. A row for each speed:
//   speed          the requested speed
//   sustained_x    heaviest hours an hour (bench/feed_run.h); with --sites, of that part of them
//   raw_mb_per_s   10^6 bytes of messages a second of wall time
//   latency_*      from the last chunk to the grid
//   bzip2_share    CPU time of bunzip alone for the same bytes, timed before and after each row,
//                  divided by that of the daemon
//   peak_mib       peak resident memory (VmHWM); at most file_mib of it is page cache (mapped
//                  files), and at most anonymous_mib is the daemon's own
//   daemon_cores, feeder_cores  CPU time divided by wall time
//   volumes        volumes whose last chunk was sent
//   ungridded      those of them that have no grid in the end
//   held           share of the time during which the feed was paused
//   cache_mib      the largest size of the cache
// --sites N: the first N of the 160 sites, each sending as much, for a trial.
// --full: the whole hour at speed 1, then a long run of 16 sites over 24 hours of the feed's clock.
#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/feed_run.h"
#include "bench/feed_soak.h"
#include "bench/measure.h"
#include "bench/national_feed.h"
#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr double unlimited_speed = 16;
constexpr double default_paced_s = 90, default_fast_s = 90, full_fast_s = 600;
constexpr int soak_sites = 16, soak_hours = 24;
constexpr std::uint64_t cache_budget = std::uint64_t{2} << 30U;
constexpr std::size_t kinds = 3;

constexpr const char* daemon_configuration =
    "[cache]\nbytes = \"2 GiB\"\n[ingest]\nspacing_km = 1.0\nextent_km = [460, 460]\n"
    "levels_km = \"0.5:16:0.5\"\n[log]\nlevel = \"warning\"\n";

// CPU seconds of bunzip alone for a byte of each kind.
class BzipCost {
  public:
    explicit BzipCost(const NationalFeed& feed) {
        for (std::size_t kind = 0; kind < kinds; ++kind) {
            const auto site = std::find_if(
                feed.sites().begin(), feed.sites().end(),
                [kind](const auto& one) { return one.kind == static_cast<int>(kind); });
            if (site == feed.sites().end()) continue;
            if (auto file = read_file(site->hours.front().path)) files_[kind] = std::move(*file);
        }
    }
    void measure() {
        for (std::size_t kind = 0; kind < kinds; ++kind) {
            Bytes peeled;
            const auto records = ldm_records(files_[kind], peeled);
            const double before_s = cpu_s();
            bunzip_all(records);
            seconds_[kind] += cpu_s() - before_s;
        }
        ++runs_;
    }
    [[nodiscard]] double seconds_for(const std::vector<std::uint64_t>& bytes_of_kind) const {
        double seconds = 0;
        for (std::size_t kind = 0; kind < kinds; ++kind) {
            if (files_[kind].empty()) continue;
            seconds += seconds_[kind] / runs_ * static_cast<double>(bytes_of_kind[kind]) /
                       static_cast<double>(files_[kind].size());
        }
        return seconds;
    }

  private:
    std::array<Bytes, kinds> files_;
    std::array<double, kinds> seconds_{};
    int runs_ = 0;
};

struct Wanted {
    Delivery delivery = Delivery::growing;
    std::string delivery_name = "growing";
    fs::path work;
    bool full = false;
    int sites = national_sites;
    std::vector<double> speeds;
    double paced_s = default_paced_s, fast_s = default_fast_s;
};

void add_row(const Wanted& wanted, double speed, const Stretch& stretch, double bunzip_s,
             double expansion, Table& table) {
    table.add({{"as", wanted.delivery_name},
               {"speed", {speed, 1}},
               {"sites", wanted.sites},
               {"sustained_x", {stretch.sustained(), 2}},
               {"raw_mb_per_s",
                {static_cast<double>(stretch.bytes) * expansion / 1e6 / stretch.wall_s, 1}},
               {"latency_p50_s", {stretch.latency_s(0.5), 3}},
               {"latency_p95_s", {stretch.latency_s(0.95), 3}},
               {"latency_max_s", {stretch.latency_s(1), 3}},
               {"bzip2_share", {bunzip_s / stretch.daemon_cpu_s, 3}},
               {"peak_mib", {stretch.memory.peak_mib, 0}},
               {"anonymous_mib", {stretch.memory.anonymous_mib, 0}},
               {"file_mib", {stretch.memory.file_mib, 0}},
               {"daemon_cores", {stretch.daemon_cpu_s / stretch.wall_s, 2}},
               {"feeder_cores", {stretch.player_cpu_s / stretch.wall_s, 3}},
               {"volumes", static_cast<int>(stretch.volumes)},
               {"ungridded", static_cast<int>(stretch.ungridded)},
               {"held", {stretch.held_s / stretch.wall_s, 2}},
               {"cache_mib", {static_cast<double>(stretch.most_cache_bytes) / mebibyte, 0}}});
    fmt::print(
        stderr,
        "speed {}: {:.0f} s of the feed ({:.2f} GB, {} chunks) in {:.1f} s, {:.1f} of them "
        "after the last chunk; at most {} files waited; {} failures, {} overflows; the daemon's "
        "own latency: median {:.2f} s, 95 % {:.2f} s\n",
        speed, stretch.feed_s, static_cast<double>(stretch.bytes) / 1e9, stretch.chunks,
        stretch.wall_s, stretch.drain_s, stretch.most_waiting, stretch.last.failures,
        stretch.last.overflows, stretch.last.latency_median_s, stretch.last.latency_p95_s);
    if (!stretch.drained) {
        fmt::print(stderr,
                   "NOT ALL WAS READ: {} files wait, {} volumes have no grid; sustained_x "
                   "and latencies say too little\n",
                   stretch.last.waiting, stretch.ungridded);
    }
    if (stretch.most_cache_bytes > cache_budget) fmt::print(stderr, "THE CACHE IS OVER BUDGET\n");
}

// Returns when the daemon has read what was there from the start; the feed's clock is then at 0.
Status begin(const NationalFeed& feed, DaemonProcess& daemon, FeedRun& run) {
    if (auto sent = run.send_beginnings(); !sent) return sent;
    if (auto watched = run.watch(feed); !watched) return watched;
    if (auto started = daemon.start(daemon_configuration); !started) return started;
    bool idle = false;
    const double warm_s = seconds_of([&] { idle = run.drain(120); });
    fmt::print(stderr, "the beginnings of {} volumes were read in {:.0f} s{}\n",
               feed.sites().size(), warm_s, idle ? "" : ", and not all");
    return {};
}

Status measure_hour(const Request& request, const Wanted& wanted, Table& table) {
    Result<NationalFeed> feed = fail(ErrorCode::internal, "");
    const double made_s = seconds_of([&] {
        feed = NationalFeed::make(wanted.sites, 1, request.data_directory(), wanted.work / "feed",
                                  request.threads.back());
    });
    if (!feed) return pass_on(feed);
    fmt::print(
        stderr,
        "feed: {} sites, {:.2f} GB on disk, {:.1f} times as much unpacked, a volume in {:.0f} "
        "s, {:.1f} chunks a second, made in {:.0f} s\n",
        feed->sites().size(), static_cast<double>(feed->bytes_on_disk()) / 1e9,
        feed->message_bytes_per_byte(), feed->period_s(), feed->chunks_a_second(), made_s);
    const fs::path root = wanted.work / fmt::format("run-{}", ::getpid());
    Status outcome;
    {
        DaemonProcess daemon(root);
        FeedRun run(*feed, daemon, wanted.delivery);
        BzipCost bzip(*feed);
        outcome = begin(*feed, daemon, run);
        for (std::size_t i = 0; outcome && i < wanted.speeds.size(); ++i) {
            StretchOptions options;
            options.speed = wanted.speeds[i];
            options.most_wall_s = options.speed <= 1 ? wanted.paced_s : wanted.fast_s;
            bzip.measure();
            const auto stretch = run.run(options);
            bzip.measure();
            if (!stretch) {
                outcome = pass_on(stretch);
            } else {
                add_row(wanted, options.speed, *stretch, bzip.seconds_for(stretch->bytes_of_kind),
                        feed->message_bytes_per_byte(), table);
            }
        }
        if (outcome && !daemon.stop()) outcome = fail(ErrorCode::internal, "the end was not clean");
    }
    std::error_code ignored;
    if (outcome) fs::remove_all(root, ignored);
    return outcome;
}

Status measure_soak(const Request& request, const Wanted& wanted, int hours, Table& table) {
    const auto feed = NationalFeed::make(soak_sites, hours, request.data_directory(),
                                         wanted.work / "feed", request.threads.back());
    if (!feed) return pass_on(feed);
    const fs::path root = wanted.work / fmt::format("soak-{}", ::getpid());
    DaemonProcess daemon(root);
    FeedRun run(*feed, daemon, wanted.delivery);
    if (auto begun = begin(*feed, daemon, run); !begun) return begun;
    StretchOptions options;
    options.speed = unlimited_speed * national_sites / soak_sites;
    options.most_feed_s = 3600.0 * hours;
    const auto stretch = run.run(options);
    if (!stretch) return pass_on(stretch);
    const bool clean = daemon.stop();
    const auto check = check_soak(*feed, run.player().volumes_sent(), daemon);
    if (!check) return pass_on(check);
    const double slope = memory_slope_mib_h(stretch->samples);
    const auto count = [](std::size_t number) { return static_cast<int>(number); };
    table.add({{"soak_hours", hours},
               {"sites", soak_sites},
               {"volumes", count(stretch->volumes)},
               {"wall_s", {stretch->wall_s, 0}},
               {"sustained_x", {stretch->sustained() * soak_sites / national_sites, 2}},
               {"slope_mib_an_hour", {slope, 2}},
               {"slope_mib_a_day_of_feed", {slope * stretch->wall_s / 3600 * 24 / hours, 2}},
               {"peak_mib", {stretch->memory.peak_mib, 0}},
               {"anonymous_mib", {stretch->memory.anonymous_mib, 0}},
               {"files", count(check->files)},
               {"rows", count(check->rows)},
               {"missing_rows", count(check->missing_rows)},
               {"wrong_rows", count(check->wrong_rows)},
               {"grids", count(check->grids)},
               {"missing_grids", count(check->missing_grids)},
               {"ungridded", count(stretch->ungridded)},
               {"cache_mib", {static_cast<double>(stretch->most_cache_bytes) / mebibyte, 0}}});
    if (!clean) return fail(ErrorCode::internal, "the end was not clean: {}", root.native());
    if (!check->agrees()) {
        return fail(ErrorCode::internal, "files, rows and grids disagree: {}", root.native());
    }
    std::error_code ignored;
    fs::remove_all(root, ignored);
    return {};
}

std::optional<Wanted> wanted_of(const Request& request) {
    Wanted wanted;
    wanted.work = fs::absolute(request.value("--work").value_or(
        (fs::temp_directory_path() / "stormcellar-bench-feed").string()));
    wanted.full = request.has("--full");
    wanted.delivery_name = request.value("--as").value_or("growing");
    const std::array<std::pair<const char*, Delivery>, 4> ways = {{{"growing", Delivery::growing},
                                                                   {"open", Delivery::open},
                                                                   {"whole", Delivery::whole},
                                                                   {"chunks", Delivery::chunks}}};
    const auto way = std::find_if(ways.begin(), ways.end(), [&](const auto& one) {
        return one.first == wanted.delivery_name;
    });
    if (way == ways.end()) return std::nullopt;
    wanted.delivery = way->second;
    if (wanted.full) {
        wanted.paced_s = 3600;
        wanted.fast_s = full_fast_s;
    }
    wanted.sites = static_cast<int>(
        number_in(request.value("--sites").value_or(std::to_string(national_sites))));
    if (wanted.sites < 1 || wanted.sites > national_sites) return std::nullopt;
    std::istringstream speeds(request.value("--speeds").value_or("1 16"));
    for (double speed = 0; speeds >> speed;)
        wanted.speeds.push_back(speed);
    const bool possible = std::all_of(wanted.speeds.begin(), wanted.speeds.end(),
                                      [](double speed) { return speed > 0 && speed <= 1000; });
    if (!possible || wanted.speeds.empty() || !speeds.eof()) return std::nullopt;
    if (const auto seconds = request.value("--seconds")) {
        wanted.paced_s = wanted.fast_s = static_cast<double>(number_in(*seconds));
        if (wanted.paced_s <= 0) return std::nullopt;
    }
    return wanted;
}

int run(int argc, char** argv) {
    const auto [request, usage_status] = read_request(
        {"bench_feed",
         "",
         "the heaviest national hour before stormcellard: speed, latency, memory, bzip2's share.\n"
         "--as growing|open|whole|chunks, --speeds \"1 16\", --seconds of each, --sites N, "
         "--soak-hours N",
         {"--full"},
         {"--work", "--as", "--speeds", "--seconds", "--sites", "--soak-hours"}},
        std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    const auto wanted = wanted_of(*request);
    if (!wanted) {
        fmt::print(stderr,
                   "bench_feed: usage: --as growing|open|whole|chunks, --speeds \"1 16\", "
                   "--seconds N\n");
        return 2;
    }
    Table table(request->json);
    const auto hours = request->value("--soak-hours");
    Status done;
    if (!hours) done = measure_hour(*request, *wanted, table);
    if (done && (hours || wanted->full)) {
        const int of_feed = hours ? static_cast<int>(number_in(*hours)) : soak_hours;
        done = measure_soak(*request, *wanted, std::clamp(of_feed, 1, soak_hours), table);
    }
    table.finish();
    if (done) return 0;
    fmt::print(stderr, "bench_feed: {}\n", done.error().message);
    return done.error().code == ErrorCode::not_found ? 3 : 1;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
