// Runs every attack at once, beside a real feed of 16 stations, and tests from outside the daemon
// that the bounds of docs/reliability.md hold.
//
//   STORMCELLAR_HOSTILE_SECONDS   duration (20; scripts/test --hostile: 1,800)
//   STORMCELLAR_HOSTILE_RATE      hostile files a second (1,000)
//   STORMCELLAR_SEED              seed of the attack (1)
#include "tests/fault/hostile_mix.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/config/descriptor_plan.h"
#include "tests/fault/faulty_daemon.h"
#include "tests/fault/hostile_feed.h"
#include "tests/fault/hostile_watch.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using std::chrono::milliseconds;

// The bounds of docs/reliability.md.
constexpr double most_p95_s = 1, most_ready_s = 5;
constexpr long most_resident_mib = 512;
// Three descriptors for the database of each known station, as in a feed of all stations, and some
// more.
constexpr std::size_t most_descriptors_afterwards = 900;
constexpr std::size_t queue_limit = 20'000;
constexpr std::uint64_t cache_bytes = 1'000'000'000;
constexpr std::uint64_t mib = std::uint64_t{1} << 20U;

// Returns the descriptors that the plan assigns to databases and growing volumes, plus a reserve
// for everything else.
std::size_t most_descriptors() {
    constexpr std::size_t reserved = 256;
    const auto plan = daemon::DescriptorPlan::of_this_process();
    return 3 * plan.databases + 3 * plan.growing + reserved;
}

std::string configuration() {
    return fmt::format(
        "[watch]\nrescan_seconds = 10\nqueue_limit = {}\n[cache]\npercent = 0\nbytes = {}\n"
        "[ingest]\nworkers = 2\nquiet_seconds = 10\nspacing_km = 4\nlevels_km = \"1:8:1\"\n",
        queue_limit, cache_bytes);
}

// The largest values, sampled four times a second.
struct Peaks {
    std::size_t descriptors = 0, waiting = 0;
    std::uint64_t state_bytes = 0, cache_bytes = 0, unnamed_bytes = 0;
};

class Sampler {
  public:
    explicit Sampler(const daemon::RunningDaemon& daemon)
        : daemon_(daemon), thread_([this] { run(); }) {}
    Sampler(const Sampler&) = delete;
    Sampler& operator=(const Sampler&) = delete;
    ~Sampler() {
        if (thread_.joinable()) end();
    }
    Peaks end() {
        ending_ = true;
        thread_.join();
        return peaks_;
    }

  private:
    void run() {
        for (int turn = 0; !ending_; ++turn) {
            const pid_t process = daemon_.id();
            peaks_.descriptors = std::max(peaks_.descriptors, open_descriptors(process));
            const json now = daemon_.status();
            if (!now.is_null()) {
                peaks_.waiting =
                    std::max(peaks_.waiting, now["pending"]["waiting"].get<std::size_t>());
            }
            if (turn % 8 == 0) {
                peaks_.state_bytes =
                    std::max(peaks_.state_bytes, disk_bytes_below(daemon_.root() / "state"));
                peaks_.cache_bytes =
                    std::max(peaks_.cache_bytes, disk_bytes_below(daemon_.cache()));
                peaks_.unnamed_bytes = std::max(peaks_.unnamed_bytes, unnamed_bytes(process));
            }
            (void)testing::eventually([this] { return ending_.load(); }, milliseconds{250});
        }
    }

    const daemon::RunningDaemon& daemon_;
    Peaks peaks_;
    std::atomic<bool> ending_ = false;
    std::thread thread_;
};

// Latencies in seconds; volumes that were never gridded have none.
struct Latencies {
    std::size_t volumes = 0, gridded = 0;
    double p50 = 0, p95 = 0, max = 0;
};

Latencies latencies_of(const std::vector<RealVolume>& volumes) {
    std::vector<double> all;
    for (const RealVolume& volume : volumes) {
        if (volume.latency_s) all.push_back(*volume.latency_s);
    }
    std::sort(all.begin(), all.end());
    Latencies found{volumes.size(), all.size()};
    if (all.empty()) return found;
    const auto at = [&](double share) {
        return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
    };
    found.p50 = at(0.5);
    found.p95 = at(0.95);
    found.max = all.back();
    return found;
}

class HostileMixTest : public ::testing::Test {
  protected:
    void SetUp() override {
        if (is_sanitized)
            GTEST_SKIP() << "a sanitizer takes time and memory, which this test measures";
        fs::create_directory(daemon_.root() / "outside");
    }
    void print_row(const HostileMix& mix, const Latencies& real, long peak_mib, const Peaks& peaks,
                   double ready_s) const {
        std::string by_kind;
        for (std::size_t i = 0; i < attack_count; ++i)
            by_kind += fmt::format("{}{} {}", i == 0 ? "" : ", ", name_of(static_cast<Attack>(i)),
                                   mix.done()[i]);
        std::printf(
            "| seconds | files | a second | by kind | real volumes | gridded | p50 s | p95 s | max "
            "s | "
            "peak MiB | descriptors | queue | state MiB | put aside MiB | cache MiB | ready s |\n"
            "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
        std::printf(
            "%s\n",
            fmt::format("| {:.0f} | {} | {:.0f} | {} | {} | {} | {:.2f} | {:.2f} | {:.2f} | {} "
                        "| {} | {} | {:.0f} | {:.0f} | {:.0f} | {:.2f} |",
                        mix.seconds(), mix.all_done(),
                        static_cast<double>(mix.all_done()) / mix.seconds(), by_kind, real.volumes,
                        real.gridded, real.p50, real.p95, real.max, peak_mib, peaks.descriptors,
                        peaks.waiting, in_mib(peaks.state_bytes), in_mib(peaks.unnamed_bytes),
                        in_mib(peaks.cache_bytes), ready_s)
                .c_str());
        std::fflush(stdout);
    }
    static void print_slow(const std::vector<RealVolume>& volumes) {
        for (const RealVolume& volume : volumes) {
            if (volume.latency_s && *volume.latency_s <= most_p95_s) continue;
            std::printf("%s came in %zu files and was gridded after %.2f s\n",
                        volume.files.back().filename().c_str(), volume.files.size(),
                        volume.latency_s.value_or(-1));
        }
    }
    static double in_mib(std::uint64_t bytes) {
        return static_cast<double>(bytes) / static_cast<double>(mib);
    }
    void expect_bounded(long peak_mib, const Peaks& peaks) {
        EXPECT_LE(peak_mib, most_resident_mib);
        EXPECT_LE(peaks.descriptors, most_descriptors());
        EXPECT_LE(peaks.waiting, queue_limit);
        EXPECT_LE(peaks.cache_bytes, cache_bytes);
        EXPECT_LE(peaks.state_bytes, most_state_bytes());
    }
    // The rows of a long run, of a million files, take some 300 MB; a short run has 20,000 files.
    [[nodiscard]] std::uint64_t most_state_bytes() const {
        return (seconds_ > 60 ? 512 : 200) * mib;
    }
    void expect_all_gridded(const std::vector<RealVolume>& volumes, const char* when) {
        std::size_t missing = 0;
        for (const RealVolume& volume : volumes) {
            if (has_whole_grid(daemon_.cache(), volume.station, volume.time)) continue;
            if (++missing <= 5)
                std::printf("%s: %s has no whole grid %s\n", volume.station.c_str(),
                            volume.files.back().c_str(), when);
        }
        EXPECT_EQ(missing, 0U) << when;
    }
    // Checks that each file of the volumes is cataloged once, as complete, in the database of its
    // station.
    void expect_cataloged(const std::vector<RealVolume>& volumes) {
        const auto rows = catalog_rows(daemon_.catalog());
        std::size_t wrong = 0;
        for (const RealVolume& volume : volumes) {
            for (const fs::path& file : volume.files) {
                const auto [begin, end] = rows.equal_range(file);
                const auto count = std::distance(begin, end);
                if (count == 1 && begin->second.state == "complete" &&
                    begin->second.database == volume.station)
                    continue;
                if (++wrong <= 5)
                    std::printf("%s: %td rows, %s\n", file.c_str(), count,
                                count == 0 ? "" : begin->second.state.c_str());
            }
        }
        EXPECT_EQ(wrong, 0U) << "files of real volumes are wrong or missing in the catalog";
    }
    void expect_nothing_left(std::size_t fresh_descriptors) {
        EXPECT_EQ(invented_among(databases_in(daemon_.catalog())), std::set<std::string>{});
        EXPECT_EQ(invented_among(domains_in(daemon_.cache())), std::set<std::string>{});
        const std::size_t descriptors = open_descriptors(daemon_.id());
        std::printf("%zu descriptors at the first start, %zu after the attack\n", fresh_descriptors,
                    descriptors);
        EXPECT_LE(descriptors, most_descriptors_afterwards);
    }

    daemon::RunningDaemon daemon_;
    int seconds_ = number_of("STORMCELLAR_HOSTILE_SECONDS", 20);
};

TEST_F(HostileMixTest, RealStationsGoOnAsBefore) {
    // The period is short enough for at least two volumes of each station in a short run.
    RealFeed feed(daemon_.drop(), daemon_.cache(), seconds_ > 60 ? 25 : seconds_ * 0.4);
    HostileMix mix({.drop = daemon_.drop(),
                    .outside = daemon_.root() / "outside",
                    .rate = static_cast<double>(number_of("STORMCELLAR_HOSTILE_RATE", 1000)),
                    .seed = static_cast<std::uint32_t>(number_of("STORMCELLAR_SEED", 1))});
    start_until_ready(daemon_, configuration());
    const std::size_t fresh_descriptors = open_descriptors(daemon_.id());
    Sampler sampler(daemon_);
    feed.begin();
    mix.begin();
    testing::pass_time(std::chrono::seconds{seconds_});  // the attack lasts this long
    const auto volumes = feed.finish(10);
    mix.end();
    const Peaks peaks = sampler.end();
    const long peak_mib = daemon_.peak_mib();
    expect_all_gridded(volumes, "at the end of the attack");
    EXPECT_EQ(daemon_.terminate(), 0);

    mix.remove_all();
    const double ready_s = start_until_ready(daemon_, configuration());
    const Latencies real = latencies_of(volumes);
    print_slow(volumes);
    print_row(mix, real, peak_mib, peaks, ready_s);
    EXPECT_GE(real.volumes, 32U);
    EXPECT_EQ(real.gridded, real.volumes);
    EXPECT_LE(real.p95, most_p95_s);
    EXPECT_LE(ready_s, most_ready_s);
    expect_bounded(peak_mib, peaks);
    EXPECT_TRUE(comes_to_rest(daemon_, 60)) << daemon_.status()["pending"].dump();
    expect_nothing_left(fresh_descriptors);
    expect_cataloged(volumes);
    expect_all_gridded(volumes, "after the restart");
    EXPECT_EQ(daemon_.terminate(), 0);
}

}  // namespace
}  // namespace stormcellar::fault
