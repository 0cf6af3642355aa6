// bench_mosaic: turns raw files of five hours of 1 to 100 radars into merged volumes for rendering.
//
// usage: bench_mosaic [--data DIR] [--work DIR] [--threads N] [--runs N] [--full]
//        [--sites | --us | --only SITES] [--hours H] [--alone] [--json] (bench/request.h)
// This is the experiment of the paper of 2008: 100 sites, 5 hours, 27 GB uncompressed, on a grid of
// 256 x 256 x 128 cells over the common box of the sites. bench/mosaic_feed.h describes the files,
// bench/mosaic_run.h what is timed. Files are made once, untimed, in the directory of --work (by
// default stormcellar-bench-mosaic in the system's directory for temporary files; 0.7 GB for 100
// sites) and used again. Merged volumes (60, one for each 5 minutes) go into a cache there, which
// is removed at the end. Each row is measured in a process of its own:
//   sites      1, 10, 30, 50, 100
//   threads    for everything timed
//   total_s    from raw files to merged volumes
//   libbz2_s   libbz2 alone over the same files with as many threads, alternating with the former
//   ratio      total_s / libbz2_s
//   expansion  bytes of messages / bytes of files
//   raw_gb     10^9 bytes of messages
//   peak_mib   peak memory of the process
//   paper_min  the paper's minutes, which are known for 100 sites: 46.87 in sequence (shown for one
//              thread), 8.92 on its pool of 512 nodes (shown for more)
// Then the rows of the United States at 0.01 degrees follow, with the columns of bench_merge, the
// least of the runs (bench/us_mosaic.h). --sites or --us: one of the two alone; --only: this number
// of sites alone; --hours: the first H of the five hours, for a trial; --alone: without the runs of
// libbz2, so that libbz2_s and ratio have no value, and no row is left out. Without --full only
// those rows are run that are expected to end within 9 minutes, judged by the bytes and seconds of
// the rows before. stderr shows what was read, what was left out, and CPU times, which are more
// reliable than total_s if other programs use the same cores. The program runs itself with
// --sites-once SITES THREADS FEED CACHE HOURS BESIDE.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/memory.h"
#include "bench/measure.h"
#include "bench/mosaic_feed.h"
#include "bench/mosaic_run.h"
#include "bench/request.h"
#include "bench/table.h"
#include "bench/us_mosaic.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr double most_default_s = 540;
constexpr double sites_of_paper = 100;
constexpr double sequential_min = 46.87, pool_min = 8.92;

int sites_once(int sites, int threads, const fs::path& feed, const fs::path& cache,
               std::chrono::hours hours, Beside beside) {
    keep_freed_memory();
    const auto run = run_mosaic(sites, threads, feed, cache, hours, FeedFiles::first_hour, beside);
    if (!run) {
        fmt::print(stderr, "bench_mosaic: {}\n", run.error().message);
        return 1;
    }
    fmt::print("{} {} {} {} {} {} {} {} {} {} {}\n", run->total_s, run->volumes_s, run->libbz2_s,
               run->size.compressed, run->size.uncompressed, run->size.dense, run->volumes,
               run->frames, high_water_kib(), run->cpu_s, run->libbz2_cpu_s);
    return 0;
}

struct SitesRow {
    MosaicRun run;
    long peak_kib = 0;
};

std::optional<SitesRow> run_sites(int sites, int threads, const fs::path& work,
                                  std::chrono::hours hours, Beside beside) {
    const fs::path cache = work / fmt::format("cache-{}", ::getpid());
    const auto said =
        run_self({"--sites-once", std::to_string(sites), std::to_string(threads),
                  (work / "feed").string(), cache.string(), std::to_string(hours.count()),
                  beside == Beside::nothing ? "nothing" : "libbz2"});
    std::error_code ignored;
    fs::remove_all(cache, ignored);
    if (!said) return std::nullopt;
    std::istringstream words(*said);
    SitesRow row;
    MosaicRun& run = row.run;
    words >> run.total_s >> run.volumes_s >> run.libbz2_s >> run.size.compressed >>
        run.size.uncompressed >> run.size.dense >> run.volumes >> run.frames >> row.peak_kib >>
        run.cpu_s >> run.libbz2_cpu_s;
    if (!words) return std::nullopt;
    return row;
}

void add_row(int sites, int threads, const SitesRow& row, Table& table) {
    const MosaicRun& run = row.run;
    const double paper_min = sites != sites_of_paper ? HUGE_VAL
                             : threads == 1          ? sequential_min
                                                     : pool_min;
    table.add({{"sites", sites},
               {"threads", threads},
               {"total_s", {run.total_s, 2}},
               {"libbz2_s", {run.libbz2_s > 0 ? run.libbz2_s : HUGE_VAL, 2}},
               {"ratio", {run.libbz2_s > 0 ? run.total_s / run.libbz2_s : HUGE_VAL, 3}},
               {"expansion", {run.size.expansion(), 2}},
               {"raw_gb", {static_cast<double>(run.size.uncompressed) / 1e9, 3}},
               {"peak_mib", {static_cast<double>(row.peak_kib) / 1024, 0}},
               {"paper_min", {paper_min, 2}}});
    fmt::print(
        stderr,
        "{} sites: {} volumes, {:.2f} GB in {:.2f} GB of files ({:.0f} % of the bytes expand "
        "8 times or less), {} merged volumes; volumes {:.2f} s, merging {:.2f} s; CPU time {:.2f} "
        "s, of libbz2 alone {:.2f} s\n",
        sites, run.volumes, static_cast<double>(run.size.uncompressed) / 1e9,
        static_cast<double>(run.size.compressed) / 1e9, 100 * run.size.dense_part(), run.frames,
        run.volumes_s, run.total_s - run.volumes_s, run.cpu_s, run.libbz2_cpu_s);
}

// Measures the rows of sites in the order in which they are run.
Status measure_sites(const Request& request, const fs::path& work, std::chrono::hours hours,
                     Table& table) {
    double elapsed_s = 0;
    double libbz2_a_site_s = 0;  // of one thread
    const auto only = request.value("--only");
    const auto beside = request.has("--alone") ? Beside::nothing : Beside::libbz2;
    for (const int sites : {1, 10, 30, 50, 100}) {
        if (only && number_in(*only) != sites) continue;
        for (const int threads : request.threads) {
            // A row takes some 1.6 times as long as libbz2 alone, which is timed as well. Making
            // files of new sites takes half as long as libbz2.
            const double expected_s = libbz2_a_site_s * sites * (0.5 + 2.6 / std::min(threads, 2));
            if (!request.has("--full") && elapsed_s + expected_s > most_default_s) {
                fmt::print(stderr, "left out: {} sites, {} threads, some {:.0f} s (--full)\n",
                           sites, threads, expected_s);
                continue;
            }
            std::optional<SitesRow> row;
            Status made;
            elapsed_s += seconds_of([&] {
                made = make_feed(sites, request.data_directory(), work / "feed", 2);
                if (made) row = run_sites(sites, threads, work, hours, beside);
            });
            if (!made) return made;
            if (!row) return fail(ErrorCode::internal, "{} sites could not be run", sites);
            add_row(sites, threads, *row, table);
            libbz2_a_site_s = row->run.libbz2_s * std::min(threads, 2) / sites;
        }
    }
    return {};
}

std::optional<std::chrono::hours> hours_of(const Request& request) {
    const auto asked = request.value("--hours");
    if (!asked) return feed_length;
    const std::chrono::hours hours(number_in(*asked));
    if (hours.count() < 1 || hours > feed_length) return std::nullopt;
    return hours;
}

int run(int argc, char** argv) {
    if (argc == 8 && std::string(argv[1]) == "--sites-once") {
        return sites_once(static_cast<int>(number_in(argv[2])),
                          static_cast<int>(number_in(argv[3])), argv[4], argv[5],
                          std::chrono::hours(number_in(argv[6])),
                          std::string(argv[7]) == "nothing" ? Beside::nothing : Beside::libbz2);
    }
    keep_freed_memory();
    const auto [request, usage_status] =
        read_request({"bench_mosaic",
                      "",
                      "raw files of many sites to merged volumes, beside the paper's figures",
                      {"--full", "--sites", "--us", "--alone"},
                      {"--work", "--only", "--hours"}},
                     std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    const fs::path work = request->value("--work").value_or(
        (fs::temp_directory_path() / "stormcellar-bench-mosaic").string());
    const auto hours = hours_of(*request);
    if (!hours) {
        fmt::print(stderr, "bench_mosaic: --hours takes 1 to {}\n", feed_length.count());
        return 2;
    }
    Table table(request->json);
    const auto exit_status = [](const Status& done) {
        if (done) return 0;
        fmt::print(stderr, "bench_mosaic: {}\n", done.error().message);
        return done.error().code == ErrorCode::not_found ? 3 : 1;
    };
    if (!request->has("--us")) {
        const int status = exit_status(measure_sites(*request, work, *hours, table));
        if (status != 0) return status;
    }
    if (!request->has("--sites") && !request->value("--only")) {
        const int status = exit_status(measure_us(*request, work, table));
        if (status != 0) return status;
    }
    table.finish();
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
