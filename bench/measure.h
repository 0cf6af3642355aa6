// bench/measure.h -- clocks, decompression by libbz2 alone, and peak memory for all benchmarks.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

using Bytes = std::vector<std::byte>;
inline constexpr double mebibyte = 1024.0 * 1024.0;

template <class Work>
double seconds_of(Work work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Returns the CPU time of all threads of this process.
[[nodiscard]] double cpu_s();

template <class Work>
void keep_least_seconds(double& least, Work work) {
    least = std::min(least, seconds_of(work));
}

// Returns the least processor time of several runs, in milliseconds. Other programs on the machine
// change processor time less than time by the clock.
template <class Work>
double least_cpu_ms(int runs, const Work& work) {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < runs; ++i) {
        const double start = cpu_s();
        work();
        least = std::min(least, 1e3 * (cpu_s() - start));
    }
    return least;
}

// Returns the bzip2 streams of the LDM records in a file; empty if there are none. `peeled`
// receives the file without its gzip layer, and the streams may point into it.
[[nodiscard]] std::vector<std::span<const std::byte>> ldm_records(const Bytes& file, Bytes& peeled);
// A file, and the streams of its LDM records (empty if it has none), as ldm_records() returns them.
struct RecordFile {
    Bytes raw;
    Bytes peeled;
    std::vector<std::span<const std::byte>> records;
};
// Reads a file. Returns none, after a message on stderr, if that fails.
[[nodiscard]] std::optional<RecordFile> read_records(const std::filesystem::path& path);

// Decompresses the streams one by one with libbz2 alone, part by part into one buffer.
void decompress_all(std::span<const std::span<const std::byte>> records);
// Decompresses all records with this project's bunzip, as level2 does.
void bunzip_all(std::span<const std::span<const std::byte>> records);

// Decodes reflectivity. If the volume does not name its station, `name` must begin with it.
[[nodiscard]] Result<level2::Volume> decode_ref(const Bytes& bytes, std::string_view name,
                                                int threads);
[[nodiscard]] Result<level2::Volume> decode_ref(const std::filesystem::path& file, int threads);
// Returns the position of the radar from the volume, or from the station table if the volume has
// none (message 1). Errors: not_found if neither has it.
[[nodiscard]] Result<grid::SitePosition> site_of(const level2::Volume& volume);
[[nodiscard]] grid::SitePosition position_of(const Station& station);

// Returns the path of a program in the same build, such as "cli/stormcellar".
[[nodiscard]] std::string built_program(const std::filesystem::path& program);
// The output of a program, and its time from start to end.
struct ProgramRun {
    double seconds = 0;
    std::string said;
};
// Runs a program to its end. Returns none, after a message on stderr, if it failed.
[[nodiscard]] std::optional<ProgramRun> run_program(const std::string& program,
                                                    std::vector<std::string> arguments);
// Runs this program again, as a child with these arguments. Returns the output of the child.
[[nodiscard]] std::optional<std::string> run_self(std::vector<std::string> arguments);
// Runs this program again, with arguments that make it print high_water_kib(). Returns the printed
// number in MiB, or NaN if the run failed.
[[nodiscard]] double peak_mib(std::vector<std::string> arguments);
// Returns the peak memory of this process in KiB, as the kernel counts it (proc(5)).
[[nodiscard]] long high_water_kib();

// Returns a quantile of the values by nearest rank, such as the 95th percentile for a `share` of
// 0.95. The values may be in any order. NaN if there are none.
[[nodiscard]] double quantile(std::vector<double> values, double share);

// Returns the whole number at the start of a text, after spaces; -1 if there is none.
[[nodiscard]] long number_in(std::string_view text);

}  // namespace stormcellar::bench
