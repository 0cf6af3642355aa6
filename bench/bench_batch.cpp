// bench_batch: grids five hours of 100 radars as a batch of tasks, beside bench_mosaic in one
// process.
//
// usage: bench_batch [--data DIR] [--work DIR] [--engine local|make|slurm] [--only SITES]
//        [--hours H] [--threads N] [--runs N] [--json] (bench/request.h)
// The raw files are those of bench_mosaic, but all of them are files (bench/mosaic_feed.h; 3.5 GB
// for 100 sites and five hours), which are made once in the directory of --work and used again. A
// task is what one station sent on one day, or the frames of an hour; --threads says how many tasks
// run at a time, each with one thread, and how many threads the one process has. Slurm must run;
// scripts/bench-batch starts one on this host. Both ways alternate, and each row is one run:
//   engine       what ran the tasks
//   sites, tasks, frames
//   batch_s      from `batch submit` to its end; with Slurm, to the end of the last task
//   mosaic_s     the same files by bench_mosaic's way, in one process
//   ratio        batch_s / mosaic_s
//   task_cpu_s   CPU time inside tasks, as their records have it
//   mosaic_cpu_s CPU time of the one process
//   cpu_ratio    task_cpu_s / mosaic_cpu_s
//   overhead_s   time in which a place for a task was not inside one, a task
//   plan_s       `batch plan`, which is not part of batch_s
// The program runs itself with --mosaic-once SITES THREADS FEED CACHE HOURS.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "base/memory.h"
#include "batch/check.h"
#include "bench/measure.h"
#include "bench/mosaic_feed.h"
#include "bench/mosaic_run.h"
#include "bench/request.h"
#include "bench/table.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours;

struct Case {
    int sites = most_sites;
    int threads = 2;
    hours length = feed_length;
    std::string engine = "local";
    fs::path work;

    [[nodiscard]] fs::path feed() const { return work / fmt::format("files-{}", sites); }
};

int mosaic_once(char** words) {
    keep_freed_memory();
    const auto run = run_mosaic(static_cast<int>(number_in(words[0])),
                                static_cast<int>(number_in(words[1])), words[2], words[3],
                                hours(number_in(words[4])), FeedFiles::every_hour, Beside::nothing);
    if (!run) {
        fmt::print(stderr, "bench_batch: {}\n", run.error().message);
        return 1;
    }
    fmt::print("{} {} {} {}\n", run->total_s, run->cpu_s, run->volumes, run->frames);
    return 0;
}

struct MosaicOnce {
    double total_s = 0, cpu_s = 0;
    int volumes = 0, frames = 0;
};

std::optional<MosaicOnce> run_mosaic_once(const Case& a_case) {
    const fs::path cache = a_case.work / fmt::format("mosaic-{}", ::getpid());
    const auto said =
        run_self({"--mosaic-once", std::to_string(a_case.sites), std::to_string(a_case.threads),
                  a_case.feed().string(), cache.string(), std::to_string(a_case.length.count())});
    std::error_code ignored;
    fs::remove_all(cache, ignored);
    if (!said) return std::nullopt;
    std::istringstream words(*said);
    MosaicOnce once;
    words >> once.total_s >> once.cpu_s >> once.volumes >> once.frames;
    if (!words) return std::nullopt;
    return once;
}

// Returns how long it took. `batch plan` takes the domain as options.
std::optional<double> plan(const Case& a_case, const fs::path& directory) {
    const grid::GridSpec domain = feed_domain(a_case.sites);
    const UtcTime from = feed_start() + std::chrono::minutes{5};
    const double width_km = domain.spacing_m * domain.nx / 1000;
    const auto ran = run_stormcellar(
        {"batch", "plan", "--source", a_case.feed().string(), "--from", format_utc(from), "--to",
         format_utc(feed_start() + a_case.length), "--mosaic", "bench",
         fmt::format("--center={},{}", domain.center_latitude_deg, domain.center_longitude_deg),
         "--extent-km", fmt::format("{},{}", width_km, width_km), "--spacing-km",
         fmt::format("{}", domain.spacing_m / 1000), "--levels-km",
         fmt::format("{}:{}:{}", domain.levels_m.front() / 1000, domain.levels_m.back() / 1000,
                     (domain.levels_m[1] - domain.levels_m[0]) / 1000),
         "-o", directory.string()});
    if (!ran) return std::nullopt;
    return ran->seconds;
}

struct BatchOnce {
    double total_s = 0, inside_s = 0;
    std::size_t tasks = 0;
    batch::Totals done;
};

// What tasks took by the clock, all together.
double seconds_inside(const batch::Plan& opened) {
    double inside_s = 0;
    for (std::size_t number = 0; number < opened.facts().tasks(); ++number) {
        const auto task = opened.task(number);
        const auto record = task ? batch::read_record(opened, *task) : std::nullopt;
        if (!record) continue;
        inside_s += std::chrono::duration<double>(record->ended - record->started).count();
    }
    return inside_s;
}

std::optional<BatchOnce> run_batch(const Case& a_case, const fs::path& directory) {
    const auto opened = batch::Plan::open(directory);
    if (!opened) return std::nullopt;
    const auto summed = [&] { return batch::check(*opened, {}); };
    const auto began = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
    // Slurm takes half a second to give a place to the next task, and these take two.
    const std::size_t elements = opened->facts().tasks() / 5 + 1;
    if (!run_stormcellar({"batch", "submit", "--plan", directory.string(), "--engine",
                          a_case.engine, "--jobs", std::to_string(a_case.threads), "--array-size",
                          std::to_string(elements)})) {
        return std::nullopt;
    }
    // Slurm has only taken the tasks; nothing says more surely than the records that they are done.
    auto report = summed();
    constexpr double longest_s = 3600;
    while (report && !report->missing.empty() && seconds() < longest_s) {
        std::this_thread::sleep_for(std::chrono::milliseconds{200});
        report = summed();
    }
    if (!report || !report->missing.empty()) return std::nullopt;
    return BatchOnce{seconds(), seconds_inside(*opened), opened->facts().tasks(), report->done};
}

bool add_row(const Case& a_case, Table& table) {
    const fs::path directory = a_case.work / fmt::format("plan-{}", ::getpid());
    const auto failed = [](const char* what) {
        fmt::print(stderr, "bench_batch: {} failed\n", what);
        return false;
    };
    const auto plan_s = plan(a_case, directory);
    if (!plan_s) return failed("batch plan");
    const auto batch = run_batch(a_case, directory);
    std::error_code ignored;
    fs::remove_all(directory, ignored);
    if (!batch) return failed("the batch");
    const auto mosaic = run_mosaic_once(a_case);
    if (!mosaic) return failed("the one process");
    const double idle_s = batch->total_s * a_case.threads - batch->inside_s;
    table.add({{"engine", a_case.engine},
               {"sites", a_case.sites},
               {"tasks", static_cast<int>(batch->tasks)},
               {"frames", static_cast<int>(batch->done.frames)},
               {"batch_s", {batch->total_s, 2}},
               {"mosaic_s", {mosaic->total_s, 2}},
               {"ratio", {batch->total_s / mosaic->total_s, 3}},
               {"task_cpu_s", {batch->done.cpu_s, 2}},
               {"mosaic_cpu_s", {mosaic->cpu_s, 2}},
               {"cpu_ratio", {batch->done.cpu_s / mosaic->cpu_s, 3}},
               {"overhead_s", {idle_s / static_cast<double>(batch->tasks), 3}},
               {"plan_s", {*plan_s, 2}}});
    fmt::print(stderr,
               "{} files of {:.2f} GB, {} left out, {:.2f} GB of grids and frames written, at most "
               "{:.0f} MiB a task; in one process {} volumes, {} frames\n",
               batch->done.files, static_cast<double>(batch->done.bytes_read) / 1e9,
               batch->done.left_out, static_cast<double>(batch->done.bytes_written) / 1e9,
               static_cast<double>(batch->done.most_memory_bytes) / mebibyte, mosaic->volumes,
               mosaic->frames);
    return true;
}

// None for bad usage, which is said.
std::optional<Case> case_of(const Request& request) {
    Case a_case;
    a_case.work = request.value("--work").value_or(
        (fs::temp_directory_path() / "stormcellar-bench-batch").string());
    if (const auto asked = request.value("--only"))
        a_case.sites = static_cast<int>(number_in(*asked));
    if (const auto asked = request.value("--hours")) a_case.length = hours(number_in(*asked));
    if (const auto asked = request.value("--engine")) a_case.engine = *asked;
    if (a_case.sites < 1 || a_case.sites > most_sites || a_case.length < hours{1} ||
        a_case.length > feed_length) {
        fmt::print(stderr, "bench_batch: --only takes 1 to {} sites, --hours 1 to {}\n", most_sites,
                   feed_length.count());
        return std::nullopt;
    }
    if (a_case.engine != "local" && a_case.engine != "make" && a_case.engine != "slurm") {
        fmt::print(stderr, "bench_batch: --engine takes local, make or slurm\n");
        return std::nullopt;
    }
    return a_case;
}

int run(int argc, char** argv) {
    if (argc == 7 && std::string(argv[1]) == "--mosaic-once") return mosaic_once(argv + 2);
    const auto [request, usage_status] =
        read_request({"bench_batch",
                      "",
                      "an archive as a batch of tasks, beside one process",
                      {},
                      {"--work", "--only", "--hours", "--engine"}},
                     std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    auto a_case = case_of(*request);
    if (!a_case) return 2;
    if (Status made =
            make_feed(a_case->sites, request->data_directory(), a_case->feed(), 2, a_case->length);
        !made) {
        fmt::print(stderr, "bench_batch: {}\n", made.error().message);
        return made.error().code == ErrorCode::not_found ? 3 : 1;
    }
    Table table(request->json);
    for (const int threads : request->threads) {
        a_case->threads = threads;
        for (int turn = 0; turn < request->runs; ++turn) {
            if (add_row(*a_case, table)) continue;
            return 1;
        }
    }
    table.finish();
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
