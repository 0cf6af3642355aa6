// bench_decode: what decoding costs beside the decompression that nobody can avoid.
//
// usage: bench_decode [--runs N] [--give-back] [FILE ...]   (default: 5 runs of every real volume)
//   --give-back   freed memory goes back to the system, as glibc would have it: see base/memory.h
// For each file and number of threads one row, tab-separated under a head of keys:
//   file         its name
//   threads      for decoding; libbz2 always has one
//   libbz2_s     seconds that libbz2 alone takes over the same LDM records, into one buffer
//   decode_s     seconds of level2::decode, from bytes in memory to arrays
//   ratio        decode_s / libbz2_s
//   mb_per_s     10^6 bytes of messages a second of decode_s
//   peak_mib     peak resident memory of a process that reads and decodes the file once
//   arrays_mib   of which the decoded arrays and radials
//   file_mib     and the file itself
// Times are the least of the runs, in each of which the three are timed one behind the other. Files
// without LDM records are left out.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "base/file_system.h"
#include "base/memory.h"
#include "bench/measure.h"
#include "level2/decode.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

double arrays_mib(const level2::Volume& volume) {
    std::size_t bytes = 0;
    for (const level2::Sweep& sweep : volume.sweeps) {
        bytes += sweep.radials.size() * sizeof(level2::Radial);
        for (const level2::SweepMoment& moment : sweep.moments)
            bytes += moment.codes8.size() + 2 * (moment.codes16.size() + moment.gate_counts.size());
    }
    return static_cast<double>(bytes) / mebibyte;
}

level2::DecodeOptions with_threads(int threads) {
    level2::DecodeOptions options;
    options.threads = threads;
    return options;
}

void measure(const fs::path& file, int runs) {
    const auto raw = read_file(file);
    if (!raw) {
        fmt::print(stderr, "{}\n", raw.error().message);
        return;
    }
    Bytes peeled;
    const auto records = ldm_records(*raw, peeled);
    if (records.empty()) return;
    const auto decoded = level2::decode(*raw);
    if (!decoded) return;
    const auto message_bytes = static_cast<double>(decoded->report.message_bytes);
    const double arrays = arrays_mib(decoded->volume);
    double libbz2_s = HUGE_VAL;
    std::array<double, 2> decode_s = {HUGE_VAL, HUGE_VAL};
    for (int run = 0; run < runs; ++run) {
        keep_least_seconds(libbz2_s, [&] { decompress_all(records); });
        for (const int threads : {1, 2}) {
            keep_least_seconds(decode_s[static_cast<std::size_t>(threads - 1)], [&] {
                if (!level2::decode(*raw, with_threads(threads))) std::abort();
            });
        }
    }
    for (const int threads : {1, 2}) {
        const double seconds = decode_s[static_cast<std::size_t>(threads - 1)];
        fmt::print("{}\t{}\t{:.4f}\t{:.4f}\t{:.3f}\t{:.1f}\t{:.1f}\t{:.1f}\t{:.1f}\n",
                   file.filename().string(), threads, libbz2_s, seconds, seconds / libbz2_s,
                   message_bytes / 1e6 / seconds,
                   peak_mib({"--decode-once", file.string(), std::to_string(threads)}).value_or(-1),
                   arrays, static_cast<double>(raw->size()) / mebibyte);
        std::fflush(stdout);
    }
}

int decode_once(const char* file, const char* threads) {
    const auto raw = read_file(file);
    if (!raw) return 1;
    if (!level2::decode(*raw, with_threads(static_cast<int>(number_in(threads))))) return 1;
    fmt::print("{}\n", high_water_kib());
    return 0;
}

int run(int argc, char** argv) {
    if (argc == 4 && std::string(argv[1]) == "--decode-once") {
        keep_freed_memory();
        return decode_once(argv[2], argv[3]);
    }
    const bool give_back =
        std::find(argv + 1, argv + argc, std::string_view{"--give-back"}) != argv + argc;
    if (!give_back) keep_freed_memory();
    const Choice choice = choice_of(std::span(argv, static_cast<std::size_t>(argc)));
    if (choice.files.empty()) {
        fmt::print(stderr, "bench_decode: no files: name some, or set STORMCELLAR_DATA\n");
        return 3;
    }
    fmt::print(
        "file\tthreads\tlibbz2_s\tdecode_s\tratio\tmb_per_s\tpeak_mib\tarrays_mib\tfile_mib\n");
    for (const fs::path& file : choice.files)
        measure(file, choice.runs);
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
