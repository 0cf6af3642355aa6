// bench_mosaic: times the way from raw files of 1 to 100 radars to merged volumes.
//
// usage: bench_mosaic [--data DIR] [--work DIR] [--threads N] [--runs N] [--full]
//        [--sites | --us | --only SITES] [--hours H] [--alone] [--cache DIR]
//        [--batch local|make|slurm] [--json]      (bench/request.h)
// This is the experiment of the paper of 2008: 100 sites, 5 hours, 27 GB uncompressed, on a grid of
// 256 x 256 x 128 cells over the common box of the sites. bench/mosaic_feed.h describes the files,
// bench/mosaic_run.h the timed work. Files are made once, untimed, in the directory of --work (by
// default stormcellar-bench-mosaic in the system's directory for temporary files; 0.7 GB for 100
// sites), and later runs use the files again. The 60 merged volumes, one for each 5 minutes, go
// into a cache in this directory, which is removed at the end. Each row is measured in a process of
// its own:
//   sites      number of sites: 1, 10, 30, 50 or 100
//   threads    number of threads of all timed work
//   total_s    time from raw files to merged volumes
//   libbz2_s   time of libbz2 alone for the same files with as many threads. Its portions alternate
//              with the portions of the work of total_s
//   ratio      total_s / libbz2_s
//   expansion  bytes of messages / bytes of files
//   raw_gb     10^9 bytes of messages
//   peak_mib   peak memory of the process
//   paper_min  the paper's minutes for 100 sites: 46.87 in sequence (shown for one thread), 8.92 on
//              its pool of 512 nodes (shown for several threads)
// --only SITES runs one number of sites. --hours H uses the first H of the five hours. --alone
// leaves out libbz2, so that libbz2_s and ratio have no value, and runs every row. Otherwise,
// without --full, a row is run only if it should end within 9 minutes by the times of earlier rows.
//
// Then the rows of the United States at 0.01 degrees follow (bench/nation.h), with the least times
// of the runs. --sites or --us prints only one of the two tables. --cache DIR keeps the mosaic
// there as the domain US.
//   update_cpu, update_s  times to merge the new volume's partial into the mosaic
//   sum_cpu     CPU time of all threads from the bytes of the new volume to the new mosaic
//   merge_cpu, merge_s    times to merge the mosaic anew from all partials
//   peak_mib    peak memory of the process so far
//
// --batch: instead compares two ways to do the work: a batch of tasks (`stormcellar batch`) and one
// process. All raw files are then made, 3.5 GB for 100 sites and five hours. A task grids a
// station's day, or merges the frames of an hour; --threads N tasks run at a time. Slurm must be
// running; scripts/bench-batch starts it. Both ways alternate, and each row is one run:
//   engine, sites, tasks, frames  the engine of the batch, and three numbers
//   batch_s      time from `batch submit` to the end of the last task
//   mosaic_s     time of one process for the same files; ratio is batch_s / mosaic_s
//   task_cpu_s, mosaic_cpu_s  CPU times inside tasks, and of one process; cpu_ratio: their ratio
//   overhead_s   time between tasks, for each task: --threads times batch_s less the time inside
//                tasks, divided by the number of tasks
//   plan_s       time of `batch plan`, which is not part of batch_s
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/memory.h"
#include "batch/check.h"
#include "bench/measure.h"
#include "bench/mosaic_feed.h"
#include "bench/mosaic_run.h"
#include "bench/nation.h"
#include "bench/request.h"
#include "bench/table.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours;

constexpr double most_default_s = 540;
constexpr double sites_of_paper = 100;
constexpr double sequential_min = 46.87, pool_min = 8.92;

struct Case {
    fs::path data, work;
    hours length = feed_length;
    FeedFiles files = FeedFiles::first_hour;
    Beside beside = Beside::libbz2;
    std::vector<int> sites = {1, 10, 30, 50, 100};
    std::optional<std::string> engine;  // given by --batch

    [[nodiscard]] fs::path feed() const {
        return work / (files == FeedFiles::first_hour ? std::string{"feed"}
                                                      : fmt::format("files-{}", sites.back()));
    }
};

// Measures one row in this process, which run_sites() started with these arguments. Returns the
// exit status.
int sites_once(char** words) {
    keep_freed_memory();
    const auto run =
        run_mosaic(static_cast<int>(number_in(words[0])), static_cast<int>(number_in(words[1])),
                   words[2], words[3], hours(number_in(words[4])),
                   std::string(words[5]) == "all" ? FeedFiles::every_hour : FeedFiles::first_hour,
                   std::string(words[6]) == "alone" ? Beside::nothing : Beside::libbz2);
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

std::optional<SitesRow> run_sites(const Case& a_case, int sites, int threads) {
    const fs::path cache = a_case.work / fmt::format("cache-{}", ::getpid());
    const auto said = run_self({"--sites-once", std::to_string(sites), std::to_string(threads),
                                a_case.feed(), cache, std::to_string(a_case.length.count()),
                                a_case.files == FeedFiles::every_hour ? "all" : "first",
                                a_case.beside == Beside::nothing ? "alone" : "beside"});
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
Status measure_sites(const Request& request, const Case& a_case, Table& table) {
    double elapsed_s = 0;
    double libbz2_a_site_s = 0;  // with one thread
    for (const int sites : a_case.sites) {
        for (const int threads : request.threads) {
            // The work of a row takes some 1.6 times as long as libbz2 alone, and the row times
            // both. Making the files of new sites takes half as long as libbz2.
            const double expected_s = libbz2_a_site_s * sites * (0.5 + 2.6 / std::min(threads, 2));
            if (!request.has("--full") && elapsed_s + expected_s > most_default_s) {
                fmt::print(stderr, "left out: {} sites, {} threads, some {:.0f} s (--full)\n",
                           sites, threads, expected_s);
                continue;
            }
            std::optional<SitesRow> row;
            Status made;
            elapsed_s += seconds_of([&] {
                made = make_feed(sites, a_case.data, a_case.feed(), 2);
                if (made) row = run_sites(a_case, sites, threads);
            });
            if (!made) return made;
            if (!row) return fail(ErrorCode::internal, "{} sites could not be run", sites);
            add_row(sites, threads, *row, table);
            libbz2_a_site_s = row->run.libbz2_s * std::min(threads, 2) / sites;
        }
    }
    return {};
}

Result<double> seconds_of_stormcellar(std::vector<std::string> words) {
    const auto ran = run_program(built_program("cli/stormcellar"), std::move(words));
    if (!ran) return fail(ErrorCode::internal, "stormcellar batch failed");
    return ran->seconds;
}

// Runs `batch plan` with the domain as options. Returns its seconds.
Result<double> plan(const Case& a_case, int sites, const fs::path& directory) {
    const grid::GridSpec domain = feed_domain(sites);
    const double width_km = domain.spacing_m * domain.nx / 1000;
    return seconds_of_stormcellar(
        {"batch", "plan", "--source", a_case.feed(), "--from",
         format_utc(feed_start() + std::chrono::minutes{5}), "--to",
         format_utc(feed_start() + a_case.length), "--mosaic", "bench",
         fmt::format("--center={},{}", domain.center_latitude_deg, domain.center_longitude_deg),
         "--extent-km", fmt::format("{},{}", width_km, width_km), "--spacing-km",
         fmt::format("{}", domain.spacing_m / 1000), "--levels-km",
         fmt::format("{}:{}:{}", domain.levels_m.front() / 1000, domain.levels_m.back() / 1000,
                     (domain.levels_m[1] - domain.levels_m[0]) / 1000),
         "-o", directory});
}

struct BatchRun {
    double total_s = 0, inside_s = 0;  // wall time; sum of the times inside all tasks
    std::size_t tasks = 0;
    batch::Totals done;
};

Result<BatchRun> run_batch(const Case& a_case, int threads, const fs::path& directory) {
    const auto opened = batch::Plan::open(directory);
    if (!opened) return pass_on(opened);
    BatchRun run;
    run.tasks = opened->facts().tasks();
    Result<batch::CheckReport> report = fail(ErrorCode::internal, "not all tasks were done");
    const auto began = std::chrono::steady_clock::now();
    // Slurm needs half a second to start the next task, and these tasks take two seconds.
    const auto submitted = seconds_of_stormcellar(
        {"batch", "submit", "--plan", directory, "--engine", *a_case.engine, "--jobs",
         std::to_string(threads), "--array-size", std::to_string(run.tasks / 5 + 1)});
    if (!submitted) return pass_on(submitted);
    // `submit` returns when Slurm has accepted the tasks, so wait for the records of all tasks.
    constexpr double longest_s = 3600;
    while (run.total_s < longest_s) {
        report = batch::check(*opened, {});
        run.total_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        if (!report || report->missing.empty()) break;
        std::this_thread::sleep_for(std::chrono::milliseconds{200});
    }
    if (!report) return pass_on(report);
    if (!report->missing.empty()) return fail(ErrorCode::internal, "tasks are missing");
    run.done = report->done;
    for (std::size_t number = 0; number < run.tasks; ++number) {
        const auto task = opened->task(number);
        const auto record = task ? batch::read_record(*opened, *task) : std::nullopt;
        if (record)
            run.inside_s += std::chrono::duration<double>(record->ended - record->started).count();
    }
    return run;
}

Status add_batch_row(const Case& a_case, int threads, Table& table) {
    const int sites = a_case.sites.back();
    const fs::path directory = a_case.work / fmt::format("plan-{}", ::getpid());
    const auto plan_s = plan(a_case, sites, directory);
    if (!plan_s) return pass_on(plan_s);
    const auto batch = run_batch(a_case, threads, directory);
    std::error_code ignored;
    fs::remove_all(directory, ignored);
    if (!batch) return pass_on(batch);
    const auto row = run_sites(a_case, sites, threads);
    if (!row) return fail(ErrorCode::internal, "the one process failed");
    const MosaicRun& mosaic = row->run;
    const double idle_s = batch->total_s * threads - batch->inside_s;
    table.add({{"engine", *a_case.engine},
               {"sites", sites},
               {"tasks", static_cast<int>(batch->tasks)},
               {"frames", static_cast<int>(batch->done.frames)},
               {"batch_s", {batch->total_s, 2}},
               {"mosaic_s", {mosaic.total_s, 2}},
               {"ratio", {batch->total_s / mosaic.total_s, 3}},
               {"task_cpu_s", {batch->done.cpu_s, 2}},
               {"mosaic_cpu_s", {mosaic.cpu_s, 2}},
               {"cpu_ratio", {batch->done.cpu_s / mosaic.cpu_s, 3}},
               {"overhead_s", {idle_s / static_cast<double>(batch->tasks), 3}},
               {"plan_s", {*plan_s, 2}}});
    fmt::print(stderr,
               "{} files of {:.2f} GB, {} left out, {:.2f} GB of grids and frames written, at most "
               "{:.0f} MiB a task; in one process {} volumes, {} frames\n",
               batch->done.files, static_cast<double>(batch->done.bytes_read) / 1e9,
               batch->done.left_out, static_cast<double>(batch->done.bytes_written) / 1e9,
               static_cast<double>(batch->done.most_memory_bytes) / mebibyte, mosaic.volumes,
               mosaic.frames);
    return {};
}

Status measure_batch(const Request& request, const Case& a_case, Table& table) {
    Status status = make_feed(a_case.sites.back(), a_case.data, a_case.feed(), 2, a_case.length);
    for (const int threads : request.threads) {
        for (int turn = 0; status && turn < request.runs; ++turn)
            status = add_batch_row(a_case, threads, table);
    }
    return status;
}

// Returns none, after a message, for bad usage.
std::optional<Case> case_of(const Request& request) {
    Case a_case;
    a_case.data = request.data_directory();
    a_case.work = request.value("--work").value_or(
        (fs::temp_directory_path() / "stormcellar-bench-mosaic").string());
    if (const auto only = request.value("--only"))
        a_case.sites = {static_cast<int>(number_in(*only))};
    if (const auto asked = request.value("--hours")) a_case.length = hours(number_in(*asked));
    if (request.has("--alone")) a_case.beside = Beside::nothing;
    a_case.engine = request.value("--batch");
    if (a_case.engine) {
        a_case.files = FeedFiles::every_hour;
        a_case.beside = Beside::nothing;
    }
    const bool is_known = !a_case.engine || *a_case.engine == "local" || *a_case.engine == "make" ||
                          *a_case.engine == "slurm";
    if (is_known && a_case.sites.back() >= 1 && a_case.sites.back() <= most_sites &&
        a_case.length >= hours{1} && a_case.length <= feed_length)
        return a_case;
    fmt::print(stderr,
               "bench_mosaic: --only takes 1 to {} sites, --hours 1 to {}, --batch local, make or "
               "slurm\n",
               most_sites, feed_length.count());
    return std::nullopt;
}

int run(int argc, char** argv) {
    if (argc == 9 && std::string(argv[1]) == "--sites-once") return sites_once(argv + 2);
    keep_freed_memory();
    const auto [request, usage_status] =
        read_request({"bench_mosaic",
                      "",
                      "raw files of many sites to merged volumes, beside the paper's figures",
                      {"--full", "--sites", "--us", "--alone"},
                      {"--work", "--only", "--hours", "--batch", "--cache"}},
                     std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    const auto a_case = case_of(*request);
    if (!a_case) return 2;
    Table table(request->json);
    Status done;
    if (a_case->engine) {
        done = measure_batch(*request, *a_case, table);
    } else {
        if (!request->has("--us")) done = measure_sites(*request, *a_case, table);
        if (done && !request->has("--sites") && !request->value("--only"))
            done = measure_nation(*request, a_case->work, request->value("--cache"), table);
    }
    if (done) table.finish();
    return exit_status("bench_mosaic", done);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
