// bench_feed: plays the heaviest national hour of Level II to the real stormcellard.
//
// usage: bench_feed [--data DIR] [--work DIR] [--as growing|open|whole|chunks] [--speeds "1 16"]
//        [--seconds N] [--sites N] [--moments "REF VELD"] [--quality P] [--full] [--soak-hours N]
//        [--threads N] [--json] (bench/request.h)
// A national feed (bench/national_feed.h) is made once, untimed, below --work. For each speed, the
// stormcellard of this build starts there with its own directories, and grids every volume at 1 km
// and 32 levels. Chunks that sites sent before the feed's clock began exist from the start. There
// is a row for each speed:
//   speed          requested speed of the feed's clock; at speed 1, an hour takes an hour
//   sustained_x    hours of the feed, or of its first --sites, that the daemon processes in an hour
//                  (bench/feed_run.h)
//   raw_mb_per_s   10^6 bytes of messages a second of wall time
//   latency_*      time from the last chunk of a volume to its grid; with --moments, to the grid of
//                  the last moment
//   bzip2_share    CPU time of bunzip alone for the same bytes, timed before and after each row,
//                  divided by the daemon's CPU time
//   peak_mib       peak resident memory of the daemon (VmHWM). At most file_mib of it is page cache
//                  (mapped files), and at most anonymous_mib is the daemon's own
//   daemon_cores, feeder_cores  CPU time of daemon and feeder divided by wall time
//   volumes        number of volumes whose last chunk was sent
//   ungridded      number of these volumes that have no grid at the end
//   held           share of the time during which the feed was paused
//   cache_mib      largest size of the cache
// --moments: the moments to grid, REF first, instead of REF alone. For VELD, the daemon dealiases.
// --quality P: leaves out echo whose probability of weather is below P ([ingest] quality).
// --sites N: uses only the first N of the 160 sites, for a trial. --soak-hours N: instead plays 16
// sites over N hours of the feed's clock, as fast as the daemon can read them. Files, rows and
// grids must agree at the end. --full: plays the whole hour at speed 1, and then 24 hours as for
// --soak-hours.
#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/feed_run.h"
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

constexpr const char* daemon_configuration =
    "[cache]\nbytes = \"2 GiB\"\n[log]\nlevel = \"warning\"\n[ingest]\nspacing_km = 1.0\n"
    "extent_km = [460, 460]\nlevels_km = \"0.5:16:0.5\"\n";

std::string configuration_for(const std::vector<level2::Moment>& moments, double quality) {
    std::string names;
    for (const level2::Moment moment : moments)
        names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", level2::moment_name(moment));
    return fmt::format("{}moments = [{}]\nquality = {:.3f}\n", daemon_configuration, names,
                       quality);
}

// Measures the CPU time of bunzip alone for the bytes of the feed.
class BzipCost {
  public:
    explicit BzipCost(const NationalFeed& feed) {
        double bytes = 0;
        for (const NationalSite& site : feed.sites()) {
            Kind& kind = kinds_[site.kind];
            if (kind.file.empty()) {
                if (auto file = read_file(site.hours.front())) kind.file = std::move(*file);
            }
            kind.share += static_cast<double>(site.bytes);
            bytes += static_cast<double>(site.bytes);
        }
        for (auto& [number, kind] : kinds_)
            kind.share /= bytes;
    }
    void measure() {
        for (const auto& [number, kind] : kinds_) {
            Bytes peeled;
            const auto records = ldm_records(kind.file, peeled);
            const double before_s = cpu_s();
            bunzip_all(records);
            seconds_ += (cpu_s() - before_s) / static_cast<double>(kind.file.size()) * kind.share;
        }
        ++runs_;
    }
    [[nodiscard]] double seconds_for(double bytes) const { return bytes * seconds_ / runs_; }

  private:
    struct Kind {
        Bytes file;
        double share = 0;  // share of the feed's bytes
    };
    std::map<int, Kind> kinds_;
    double seconds_ = 0;
    int runs_ = 0;
};

struct Wanted {
    synth::Delivery delivery = synth::Delivery::growing;
    std::string delivery_name = "growing";
    fs::path work;
    bool full = false;
    int sites = national_sites;
    std::vector<double> speeds;
    std::vector<level2::Moment> moments;
    double quality = 0;  // keeps all echo
    double paced_s = default_paced_s, fast_s = default_fast_s;
};

void add_row(const Wanted& wanted, double speed, const Stretch& stretch, double bunzip_s,
             double expansion, Table& table) {
    table.add({{"as", wanted.delivery_name},
               {"speed", {speed, 1}},
               {"sites", wanted.sites},
               {"sustained_x", {stretch.sustained, 2}},
               {"raw_mb_per_s", {stretch.bytes * expansion / 1e6 / stretch.wall_s, 1}},
               {"latency_p50_s", {quantile(stretch.latencies_s, 0.5), 3}},
               {"latency_p95_s", {quantile(stretch.latencies_s, 0.95), 3}},
               {"latency_max_s", {quantile(stretch.latencies_s, 1), 3}},
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
    fmt::print(stderr,
               "speed {}: {:.2f} GB in {:.1f} s, {:.1f} of them after the last chunk; at most {} "
               "files waited; {} failures, {} overflows\n",
               speed, stretch.bytes / 1e9, stretch.wall_s, stretch.drain_s, stretch.most_waiting,
               stretch.last.failures, stretch.last.overflows);
    if (!stretch.drained) {
        fmt::print(stderr,
                   "NOT ALL WAS READ: {} files wait, {} volumes have no grid; sustained_x "
                   "and latencies say too little\n",
                   stretch.last.waiting, stretch.ungridded);
    }
    if (stretch.most_cache_bytes > cache_budget) fmt::print(stderr, "THE CACHE IS OVER BUDGET\n");
}

// Plays the feed once to a new daemon, and calls `check` after the daemon has ended. If anything
// fails, the directories of the daemon are kept.
Status play(const NationalFeed& feed, const Wanted& wanted, StretchOptions options,
            const std::function<Status(const Stretch&, const DaemonProcess&)>& check) {
    const fs::path root = wanted.work / fmt::format("run-{}", ::getpid());
    DaemonProcess daemon(root);
    FeedRun run(feed, daemon);
    options.last_moment = wanted.moments.back();
    const auto stretch = run.run(options, configuration_for(wanted.moments, wanted.quality));
    if (!stretch) return pass_on(stretch);
    if (!daemon.stop())
        return fail(ErrorCode::internal, "the end was not clean: {}", root.native());
    if (Status checked = check(*stretch, daemon); !checked) return checked;
    std::error_code ignored;
    fs::remove_all(root, ignored);
    return {};
}

Status measure_hour(const Request& request, const Wanted& wanted, Table& table) {
    const auto feed = NationalFeed::make(wanted.sites, 1, request.data_directory(),
                                         wanted.work / "feed", request.threads.back());
    if (!feed) return pass_on(feed);
    fmt::print(stderr,
               "feed: {} sites, {:.1f} times as much unpacked, a volume in {:.0f} s, {:.1f} chunks "
               "a second\n",
               feed->sites().size(), feed->message_bytes_per_byte(), feed->period_s(),
               feed->chunks_a_second());
    for (const double speed : wanted.speeds) {
        StretchOptions options;
        options.delivery = wanted.delivery;
        options.speed = speed;
        options.most_wall_s = speed <= 1 ? wanted.paced_s : wanted.fast_s;
        options.most_feed_s = options.most_wall_s * speed + feed->period_s();
        BzipCost bzip(*feed);
        bzip.measure();
        Status played = play(*feed, wanted, options, [&](const Stretch& stretch, const auto&) {
            bzip.measure();
            add_row(wanted, speed, stretch, bzip.seconds_for(stretch.bytes),
                    feed->message_bytes_per_byte(), table);
            return Status{};
        });
        if (!played) return played;
    }
    return {};
}

Status measure_soak(const Request& request, const Wanted& wanted, int hours, Table& table) {
    const auto feed = NationalFeed::make(soak_sites, hours, request.data_directory(),
                                         wanted.work / "feed", request.threads.back());
    if (!feed) return pass_on(feed);
    StretchOptions options;
    options.delivery = wanted.delivery;
    options.speed = unlimited_speed * national_sites / soak_sites;
    options.most_feed_s = 3600.0 * hours;
    return play(*feed, wanted, options, [&](const Stretch& stretch, const DaemonProcess& daemon) {
        const auto check = check_soak(*feed, stretch.volumes_sent, daemon);
        if (!check) return Status(pass_on(check));
        const double slope = memory_slope_mib_h(stretch.samples);
        const auto count = [](std::size_t number) { return static_cast<int>(number); };
        table.add({{"soak_hours", hours},
                   {"sites", soak_sites},
                   {"volumes", count(stretch.volumes)},
                   {"wall_s", {stretch.wall_s, 0}},
                   {"sustained_x", {stretch.sustained * soak_sites / national_sites, 2}},
                   {"slope_mib_an_hour", {slope, 2}},
                   {"slope_mib_a_day_of_feed", {slope * stretch.wall_s / 3600 * 24 / hours, 2}},
                   {"peak_mib", {stretch.memory.peak_mib, 0}},
                   {"anonymous_mib", {stretch.memory.anonymous_mib, 0}},
                   {"files", count(check->files)},
                   {"rows", count(check->rows)},
                   {"missing_rows", count(check->missing_rows)},
                   {"wrong_rows", count(check->wrong_rows)},
                   {"grids", count(check->grids)},
                   {"missing_grids", count(check->missing_grids)},
                   {"ungridded", count(stretch.ungridded)},
                   {"cache_mib", {static_cast<double>(stretch.most_cache_bytes) / mebibyte, 0}}});
        if (check->agrees()) return Status{};
        return Status(fail(ErrorCode::internal, "files, rows and grids disagree"));
    });
}

std::optional<Wanted> wanted_of(const Request& request) {
    Wanted wanted;
    wanted.work = fs::absolute(request.value("--work").value_or(
        (fs::temp_directory_path() / "stormcellar-bench-feed").string()));
    wanted.full = request.has("--full");
    wanted.delivery_name = request.value("--as").value_or("growing");
    using synth::Delivery;
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
    std::istringstream moments(
        request.value("--moments").value_or(std::string(level2::moment_name(level2::Moment::ref))));
    for (std::string name; moments >> name;) {
        const auto moment = level2::moment_from_name(name);
        if (!moment) return std::nullopt;
        wanted.moments.push_back(*moment);
    }
    if (wanted.moments.empty() || wanted.moments.front() != level2::Moment::ref)
        return std::nullopt;
    std::istringstream quality(request.value("--quality").value_or("0"));
    if (!(quality >> wanted.quality) || wanted.quality < 0 || wanted.quality > 1)
        return std::nullopt;
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
         "--as growing|open|whole|chunks, --speeds \"1 16\", --seconds of each,\n"
         "--moments \"NAME ...\", --quality P",
         {"--full"},
         {"--work", "--as", "--speeds", "--seconds", "--sites", "--moments", "--quality",
          "--soak-hours"}},
        std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    const auto wanted = wanted_of(*request);
    if (!wanted) {
        fmt::print(stderr,
                   "bench_feed: usage: --as growing|open|whole|chunks, --speeds \"1 16\", "
                   "--seconds N, --moments \"NAME ...\", --quality P\n");
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
    return exit_status("bench_feed", done);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
