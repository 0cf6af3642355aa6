// bench_records: how long it takes to see how far a plan of thirty years is.
//
// usage: bench_records [--work DIR] [--tasks N] [--json] (bench/request.h)
// The plan has a task for each station and day of the public bucket, 1.8 million by default, and
// each task a made-up record, as `stormcellar batch run` would have written it. Records are written
// without waiting for the disk, some 4 KiB of it each; the directory below --work (by default that
// of temporary files) is removed at the end.
//   tasks
//   plan_s       writing the plan
//   plan_mb      its size
//   records_s    writing the records, and what sums them up: done by tasks as they end
//   check_s      `batch check`, which reads the sums
//   one_by_one_s the same without sums, record by record
//   peak_mib     largest memory of all this
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "batch/check.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr long default_tasks = 1'800'000;
constexpr int stations = 164;
constexpr std::size_t volumes_a_day = 240;

Status write_plan(const fs::path& directory, long tasks) {
    std::vector<std::string> names;
    for (const Station& station : all_stations()) {
        if (names.size() < stations) names.emplace_back(station.icao);
    }
    const std::chrono::days length((tasks + stations - 1) / stations);
    batch::Recipe recipe;
    recipe.source = "https://bucket.invalid";
    recipe.cache = directory / "cache";
    recipe.from = std::chrono::sys_days{std::chrono::year{1991} / 6 / 1};
    recipe.to = recipe.from + length - std::chrono::milliseconds{1};
    auto listing = batch::every_day_of(names, recipe.from, recipe.to);
    listing.days.resize(static_cast<std::size_t>(tasks));
    return batch::write_plan(directory, recipe, listing.days);
}

batch::Record made_up(const batch::Plan& plan, const batch::Task& task) {
    const auto& day = std::get<batch::StationDay>(task.work);
    batch::Record record;
    record.number = task.number;
    record.plan = plan.facts().hash;
    record.station = day.station;
    record.day = format_compact(UtcTime{day.day}).substr(0, 8);
    record.files = record.grids = volumes_a_day;
    record.taken_by_hour.fill(volumes_a_day / 24);
    record.digest = fmt::format("{:016x}", task.number);
    record.started = UtcTime{std::chrono::sys_days{std::chrono::year{2026} / 1 / 1}} +
                     std::chrono::seconds(task.number);
    record.ended = record.started + std::chrono::seconds{45};
    record.cpu_s = 45;
    record.bytes_read = 1'500'000'000;
    record.bytes_written = 400'000'000;
    record.memory_bytes = 300'000'000;
    record.host = "n1";
    return record;
}

// The last task of each directory sums it up, as it would.
Status write_records(const batch::Plan& plan) {
    for (std::size_t number = 0; number < plan.facts().tasks(); ++number) {
        const auto task = plan.task(number);
        if (!task) return pass_on(task);
        const batch::Record record = made_up(plan, *task);
        const std::size_t next = number + 1;
        if (next % batch::records_a_directory == 0 || next == plan.facts().tasks()) {
            if (Status kept = batch::keep_record(plan, record); !kept) return kept;
            continue;
        }
        const fs::path path = batch::record_path(plan.directory(), number);
        if (number % batch::records_a_directory == 0) fs::create_directories(path.parent_path());
        if (!(std::ofstream(path) << batch::text_of(record)))
            return fail(ErrorCode::io, "{}: cannot be written", path.string());
    }
    return {};
}

// Returns the seconds of a check that finds all tasks done.
Result<double> time_check(const batch::Plan& plan) {
    Result<batch::CheckReport> report = fail(ErrorCode::internal, "not run");
    const double seconds = seconds_of([&] { report = batch::check(plan, {}); });
    if (!report) return pass_on(report);
    if (report->done.tasks() != plan.facts().tasks() || !report->missing.empty())
        return fail(ErrorCode::internal, "{} tasks count as missing", report->missing.size());
    return seconds;
}

void remove_sums(const fs::path& plan) {
    for (const auto& directory : fs::directory_iterator(plan / "tasks"))
        fs::remove(directory.path() / "summary.json");
}

Status measure(const fs::path& directory, long tasks, Table& table) {
    Status done;
    const double plan_s = seconds_of([&] { done = write_plan(directory, tasks); });
    if (!done) return done;
    const auto plan = batch::Plan::open(directory);
    if (!plan) return pass_on(plan);
    const double records_s = seconds_of([&] { done = write_records(*plan); });
    if (!done) return done;
    const auto check_s = time_check(*plan);
    if (!check_s) return pass_on(check_s);
    remove_sums(directory);
    const auto one_by_one_s = time_check(*plan);
    if (!one_by_one_s) return pass_on(one_by_one_s);
    table.add({{"tasks", static_cast<int>(tasks)},
               {"plan_s", {plan_s, 1}},
               {"plan_mb", {static_cast<double>(fs::file_size(directory / "plan.jsonl")) / 1e6, 0}},
               {"records_s", {records_s, 1}},
               {"check_s", {*check_s, 2}},
               {"one_by_one_s", {*one_by_one_s, 1}},
               {"peak_mib", {static_cast<double>(high_water_kib()) / 1024, 0}}});
    return {};
}

int run(int argc, char** argv) {
    const auto [request, usage_status] = read_request(
        {"bench_records", "", "how far a plan of millions of tasks is", {}, {"--work", "--tasks"}},
        std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    const auto asked = request->value("--tasks");
    const long tasks = asked ? number_in(*asked) : default_tasks;
    if (tasks < 1 || tasks > 4'000'000) {
        fmt::print(stderr, "bench_records: --tasks takes 1 to 4000000\n");
        return 2;
    }
    const fs::path work = request->value("--work").value_or(fs::temp_directory_path().string());
    const fs::path directory = work / fmt::format("stormcellar-bench-records-{}", ::getpid());
    Table table(request->json);
    const Status measured = measure(directory, tasks, table);
    std::error_code ignored;
    fs::remove_all(directory, ignored);
    if (!measured) {
        fmt::print(stderr, "bench_records: {}\n", measured.error().message);
        return 1;
    }
    table.finish();
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
