// bench_bunzip: measures the decompression of LDM records by each path of bunzip and by libbz2.
//
// usage: bench_bunzip [--data DIR] [--threads N] [--runs N] [--json] [FILE ...]
//   (bench/request.h; every real volume, unless files are named)
// For each file there is a row for each path that this machine supports, one record at a time and
// all records in one call, and for each number of threads:
//   file, path    libbz2, plain, avx2, avx512; lbzip2 if that program is installed
//   batch         records a call: 1, as they arrive live, or all
//   threads       1 for single records, because live records arrive one at a time
//   mb_per_s      10^6 bytes of output a second
//   ratio         time of libbz2 on one thread, one record at a time, divided by this time
//   kib_a_record  mean output of a record
// Times are the least of the runs. In each run, all are timed one after the other, libbz2 first.
// All outputs are first compared with those of libbz2. lbzip2 reads a file of all records, so its
// time includes its start, some 2 ms. Files without LDM records are left out.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "base/memory.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "bunzip/bunzip.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using bunzip::Path;
using Records = std::vector<std::span<const std::byte>>;

constexpr std::size_t most_bytes = std::size_t{1} << 30;

// One way to decompress all records of a file.
struct Way {
    std::string path;
    std::string batch;
    int threads = 1;
    std::function<void()> work;
    double least_s = HUGE_VAL;
};

struct Rooms {
    std::vector<bunzip::Workspace> workspaces;
    std::vector<std::byte> buffer;
    std::vector<bunzip::Job> jobs;
};

void stop_unless(bool good, const char* what) {
    if (good) return;
    fmt::print(stderr, "bench_bunzip: {}\n", what);
    std::exit(1);
}

void one_by_one(const Records& records, Path path, Rooms& rooms) {
    for (const auto record : records) {
        const auto outcome =
            bunzip::decompress(record, rooms.buffer, most_bytes, rooms.workspaces[0], path);
        stop_unless(outcome.status == bunzip::Status::whole, "a record is not whole");
    }
}

void at_once(const Records& records, Path path, int threads, Rooms& rooms) {
    rooms.jobs.resize(records.size());
    for (std::size_t i = 0; i < records.size(); ++i)
        rooms.jobs[i].stream = records[i];
    bunzip::decompress_all(rooms.jobs, most_bytes,
                           std::span{rooms.workspaces}.first(static_cast<std::size_t>(threads)),
                           path);
}

void compare(const Records& records, Path path, Rooms& rooms) {
    std::vector<std::byte> wanted;
    for (const auto record : records) {
        const auto by_libbz2 =
            bunzip::decompress(record, wanted, most_bytes, rooms.workspaces[0], Path::libbz2);
        const auto outcome =
            bunzip::decompress(record, rooms.buffer, most_bytes, rooms.workspaces[0], path);
        const auto bytes = static_cast<std::ptrdiff_t>(by_libbz2.output_bytes);
        stop_unless(outcome.output_bytes == by_libbz2.output_bytes &&
                        std::equal(wanted.begin(), wanted.begin() + bytes, rooms.buffer.begin()),
                    "other bytes than libbz2's");
    }
}

fs::path write_joined(const Records& records) {
    fs::path path = fs::temp_directory_path() / fmt::format("bench-bunzip-{}.bz2", ::getpid());
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    stop_unless(file != nullptr, "no temporary file");
    for (const auto record : records)
        std::fwrite(record.data(), 1, record.size(), file);
    stop_unless(std::fclose(file) == 0, "no temporary file");
    return path;
}

std::vector<Way> ways_of(const Records& records, const Request& request, const fs::path& joined,
                         Rooms& rooms) {
    std::vector<Way> ways;
    for (const Path path : bunzip::all_paths) {
        if (!bunzip::is_available(path)) continue;
        compare(records, path, rooms);
        const std::string name{name_of(path)};
        ways.push_back(
            {name, "1", 1, [&records, &rooms, path] { one_by_one(records, path, rooms); }});
        for (const int threads : request.threads) {
            ways.push_back({name, "all", threads, [&records, &rooms, path, threads] {
                                at_once(records, path, threads, rooms);
                            }});
        }
    }
    if (std::system("command -v lbzip2 >/dev/null") != 0) return ways;
    for (const int threads : request.threads) {
        const std::string command =
            fmt::format("lbzip2 -dc -n {} '{}' >/dev/null", threads, joined.native());
        ways.push_back({"lbzip2", "all", threads, [command] {
                            stop_unless(std::system(command.c_str()) == 0, "lbzip2 failed");
                        }});
    }
    return ways;
}

void measure(const fs::path& file, const Request& request, Table& table) {
    const auto found = read_records(file);
    if (!found || found->records.empty()) return;
    const Records& records = found->records;
    Rooms rooms;
    rooms.workspaces.resize(static_cast<std::size_t>(
        *std::max_element(request.threads.begin(), request.threads.end())));
    const fs::path joined = write_joined(records);
    std::vector<Way> ways = ways_of(records, request, joined, rooms);
    for (int run = 0; run < request.runs; ++run) {
        for (Way& way : ways)
            keep_least_seconds(way.least_s, way.work);
    }
    std::error_code ignored;
    fs::remove(joined, ignored);
    double megabytes = 0;
    at_once(records, Path::libbz2, 1, rooms);
    for (const bunzip::Job& job : rooms.jobs)
        megabytes += static_cast<double>(job.outcome.output_bytes) / 1e6;
    for (const Way& way : ways) {
        table.add(
            {{"file", file.filename().string()},
             {"path", way.path},
             {"batch", way.batch},
             {"threads", way.threads},
             {"mb_per_s", {megabytes / way.least_s, 1}},
             {"ratio", {ways.front().least_s / way.least_s, 2}},
             {"kib_a_record", {megabytes * 1e6 / 1024 / static_cast<double>(records.size()), 0}}});
    }
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    stormcellar::keep_freed_memory();
    return stormcellar::bench::run_over_files(
        {"bench_bunzip", "[FILE ...]", "LDM records decompressed by each path, beside libbz2"},
        std::span(argv, static_cast<std::size_t>(argc)), stormcellar::bench::measure);
}
