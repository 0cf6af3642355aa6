// bench_kernels: compares ways to decompress and decode volumes, and to place columns.
//
// usage: bench_kernels [--data DIR] [--threads N] [--runs N] [--json] [--benchmark_filter=REGEX]
//        [FILE ...]   (bench/request.h; every real volume, unless files are named)
// Google Benchmark times all ways in runs that alternate at random. A row has:
//   group    the work: "volume FILE" or "columns PROJECTION"
//   way      name of the way to do it
//   ms       least time of the runs
//   ratio    time of the group's first way divided by this time
// A way of a group "volume FILE" decompresses only the LDM records, or decodes the whole file. The
// first way is libbz2 on one thread, one record after another. All other ways of decompression must
// first give the same bytes. A way of a group "columns PROJECTION" computes the geometry of 512 x
// 512 columns 120 km from the site; these groups are left out if files are named. The filter is
// matched with "GROUP/WAY".
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "base/memory.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "bunzip/bunzip.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using bunzip::Path;
using Records = std::vector<std::span<const std::byte>>;

constexpr std::size_t most_bytes = std::size_t{1} << 30;

// All ways, in groups. Rows have the order in which the ways were added.
class Kernels {
  public:
    explicit Kernels(int runs) : runs_(runs) {}
    // Adds a way. `work` is timed.
    void add(const std::string& group, const std::string& way, std::function<void()> work) {
        ways_.emplace_back(group, way);
        benchmark::RegisterBenchmark((group + '/' + way).c_str(),
                                     [work = std::move(work)](benchmark::State& state) {
                                         for (const auto _ : state)
                                             work();
                                     })
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime()
            ->Repetitions(runs_);
    }
    // Adds a row for each way in `least_ms`, whose keys are GROUP/WAY.
    void add_rows(const std::map<std::string, double>& least_ms, Table& table) const {
        std::map<std::string, double> first_ms;  // by group
        for (const auto& [group, way] : ways_) {
            const auto found = least_ms.find(group + '/' + way);
            if (found == least_ms.end()) continue;  // the filter left it out
            const double ms = found->second;
            const double first = first_ms.try_emplace(group, ms).first->second;
            table.add(
                {{"group", group}, {"way", way}, {"ms", {ms, 3}}, {"ratio", {first / ms, 2}}});
        }
    }

  private:
    int runs_;
    std::vector<std::pair<std::string, std::string>> ways_;
};

class LeastReporter : public benchmark::BenchmarkReporter {
  public:
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration) continue;
            const double ms = run.GetAdjustedRealTime();
            double& least = least_ms.try_emplace(run.run_name.function_name, ms).first->second;
            least = std::min(least, ms);
        }
    }
    std::map<std::string, double> least_ms;
};

void stop_unless(bool good, std::string_view what) {
    if (good) return;
    fmt::print(stderr, "bench_kernels: {}\n", what);
    std::exit(1);
}

// A volume in memory, with the buffers for its decompression.
struct LoadedVolume {
    RecordFile file;
    std::vector<bunzip::Workspace> workspaces;
    std::vector<std::byte> buffer;
    std::vector<bunzip::Job> jobs;

    void one_by_one(Path path) {
        for (const auto record : file.records) {
            const auto outcome =
                bunzip::decompress(record, buffer, most_bytes, workspaces[0], path);
            stop_unless(outcome.status == bunzip::Status::whole, "a record is not whole");
        }
    }
    void at_once(Path path, int threads) {
        jobs.resize(file.records.size());
        for (std::size_t i = 0; i < jobs.size(); ++i)
            jobs[i].stream = file.records[i];
        bunzip::decompress_all(
            jobs, most_bytes, std::span{workspaces}.first(static_cast<std::size_t>(threads)), path);
    }
    void compare_with_libbz2(Path path) {
        std::vector<std::byte> wanted;
        for (const auto record : file.records) {
            const auto by_libbz2 =
                bunzip::decompress(record, wanted, most_bytes, workspaces[0], Path::libbz2);
            const auto outcome =
                bunzip::decompress(record, buffer, most_bytes, workspaces[0], path);
            const auto size = static_cast<std::ptrdiff_t>(by_libbz2.output_bytes);
            stop_unless(outcome.output_bytes == by_libbz2.output_bytes &&
                            std::equal(wanted.begin(), wanted.begin() + size, buffer.begin()),
                        "other bytes than libbz2's");
        }
    }
};

void decode(const Bytes& bytes, int threads) {
    level2::DecodeOptions options;
    options.threads = threads;
    stop_unless(level2::decode(bytes, options).has_value(), "a volume cannot be decoded");
}

// Adds the ways for a volume; libbz2 is the first.
void add_volume(const fs::path& path, const Request& request, std::deque<LoadedVolume>& volumes,
                Kernels& kernels) {
    auto found = read_records(path);
    if (!found || found->records.empty()) return;
    LoadedVolume& volume = volumes.emplace_back();
    volume.file = std::move(*found);
    const int most = *std::max_element(request.threads.begin(), request.threads.end());
    volume.workspaces.resize(static_cast<std::size_t>(most));
    const std::string group = "volume " + path.filename().string();
    for (const Path way : bunzip::all_paths) {
        if (!bunzip::is_available(way)) continue;
        volume.compare_with_libbz2(way);
        const std::string name{name_of(way)};
        kernels.add(group, name, [&volume, way] { volume.one_by_one(way); });
        for (const int threads : request.threads) {
            kernels.add(group, fmt::format("{}, one call, threads {}", name, threads),
                        [&volume, way, threads] { volume.at_once(way, threads); });
        }
    }
    for (const int threads : request.threads) {
        kernels.add(group, fmt::format("decode, threads {}", threads),
                    [&volume, threads] { decode(volume.file.raw, threads); });
    }
}

void add_columns(Kernels& kernels) {
    const grid::SitePosition site{"KTLX", 35.3333, -97.2778, 389};
    for (const grid::ProjectionFacts& facts : grid::projection_facts) {
        grid::GridSpec spec = grid::default_spec(36.1, -96.2);
        spec.projection = facts.projection;
        spec.nx = spec.ny = 512;
        if (spec.in_degrees()) {
            spec.spacing_m = 0;
            spec.spacing_deg = 0.01;
        }
        if (facts.takes_parallels) spec.parallels_deg = {33, 45};
        for (const auto kind :
             {grid::FrameKind::geodesic, grid::FrameKind::table, grid::FrameKind::sphere}) {
            kernels.add(fmt::format("columns {}", grid::projection_name(facts.projection)),
                        std::string(grid::frame_kind_name(kind)), [site, spec, kind] {
                            stop_unless(grid::make_column_geometry(site, spec, kind).has_value(),
                                        "no geometry");
                        });
        }
    }
}

// Passes arguments that begin with --benchmark_ to Google Benchmark, and reads all other arguments.
int run(std::span<char* const> arguments) {
    std::vector<char*> ours, theirs = {arguments.front()};
    std::array<std::string, 2> usual = {"--benchmark_enable_random_interleaving=true",
                                        "--benchmark_min_time=0.05"};
    for (std::string& word : usual)
        theirs.push_back(word.data());
    for (char* const word : arguments)
        (std::string_view{word}.starts_with("--benchmark_") ? theirs : ours).push_back(word);
    const auto [request, status] =
        read_request({"bench_kernels", "[FILE ...]",
                      "small parts of the work, each beside another way; --benchmark_filter=REGEX"},
                     ours);
    if (!request) return status;
    int count = static_cast<int>(theirs.size());
    benchmark::Initialize(&count, theirs.data());
    if (benchmark::ReportUnrecognizedArguments(count, theirs.data())) return 2;
    Kernels kernels(request->runs);
    std::deque<LoadedVolume> volumes;
    for (const fs::path& file : request->volumes())
        add_volume(file, *request, volumes, kernels);
    if (request->files.empty()) add_columns(kernels);
    LeastReporter reporter;
    if (benchmark::RunSpecifiedBenchmarks(&reporter) == 0) {
        fmt::print(stderr, "bench_kernels: nothing to measure\n");
        return 3;
    }
    Table table(request->json);
    kernels.add_rows(reporter.least_ms, table);
    table.finish();
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    stormcellar::keep_freed_memory();
    return stormcellar::bench::run({argv, static_cast<std::size_t>(argc)});
}
