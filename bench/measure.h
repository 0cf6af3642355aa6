// bench/measure.h -- what the benchmarks share: clocks, libbz2 alone, peak memory.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

// Returns the streams of the LDM records in a file; empty if there are none. If it is a gzip file,
// they point into `peeled`.
[[nodiscard]] std::vector<std::span<const std::byte>> ldm_records(const Bytes& file, Bytes& peeled);
// A file, and the streams of its LDM records, which are empty where it has none. The records point
// into `peeled`, which is the file without its gzip layer, if it has one.
struct RecordFile {
    Bytes raw;
    Bytes peeled;
    std::vector<std::span<const std::byte>> records;
};
// None where the file cannot be read, which is then said on stderr.
[[nodiscard]] std::optional<RecordFile> read_records(const std::filesystem::path& path);

// Decompresses all records with libbz2 alone, one stream each, into parts of one buffer.
void decompress_all(std::span<const std::span<const std::byte>> records);
// Does the same by bunzip's usual path, as level2 does.
void bunzip_all(std::span<const std::span<const std::byte>> records);

// Runs this program with these arguments in a process of its own. Returns what it prints, up to 64
// KiB; none if it failed.
[[nodiscard]] std::optional<std::string> run_self(std::vector<std::string> arguments);
// Does the same if it prints high_water_kib().
[[nodiscard]] std::optional<double> peak_mib(std::vector<std::string> arguments);
// Returns the peak memory of this process in KiB, as the kernel counts it (proc(5)).
[[nodiscard]] long high_water_kib();

// The time of the program `stormcellar` built with the benchmarks, from its start to its end, and
// what it printed on stdout, up to 64 KiB. None if it failed or does not exist.
struct ProgramRun {
    double seconds = 0;
    std::string said;
};
[[nodiscard]] std::optional<ProgramRun> run_stormcellar(std::vector<std::string> arguments);

// Returns the quantile of a share, such as 0.95, by nearest rank, of values in any order; NaN if
// there are none.
[[nodiscard]] double quantile(std::vector<double> values, double share);

// Returns the whole number at the start of a text, after spaces; -1 if there is none.
[[nodiscard]] long number_in(std::string_view text);

}  // namespace stormcellar::bench
