// bench_decode: compares the cost of decoding with that of decompression alone.
//
// usage: bench_decode [--data DIR] [--threads N] [--runs N] [--json] [--give-back] [FILE ...]
//   (bench/request.h; every real volume, unless files are named)
//   --give-back   freed memory goes back to the system, as is glibc's default: see base/memory.h
// There is a row for each file and number of threads:
//   file         its name
//   threads      for decoding; libbz2 always has one
//   libbz2_s     seconds of libbz2 alone over the same LDM records, into one buffer
//   decode_s     seconds of level2::decode, from bytes in memory to arrays
//   ratio        decode_s / libbz2_s
//   mb_per_s     10^6 bytes of messages a second of decode_s
//   peak_mib     peak resident memory of a process that reads and decodes the file once
//   arrays_mib   the part of it that decoded arrays and radials take
//   file_mib     the part that the file itself takes
// Times are the least of the runs. In each run, all are timed one after the other. Files without
// LDM records are left out.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/memory.h"
#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"

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

void measure(const fs::path& file, const Request& request, Table& table) {
    const auto found = read_records(file);
    if (!found || found->records.empty()) return;
    const Bytes& raw = found->raw;
    const auto decoded = level2::decode(raw);
    if (!decoded) return;
    const auto message_bytes = static_cast<double>(decoded->report.message_bytes);
    const double arrays = arrays_mib(decoded->volume);
    double libbz2_s = HUGE_VAL;
    std::vector<double> decode_s(request.threads.size(), HUGE_VAL);
    for (int run = 0; run < request.runs; ++run) {
        keep_least_seconds(libbz2_s, [&] { decompress_all(found->records); });
        for (std::size_t i = 0; i < decode_s.size(); ++i) {
            keep_least_seconds(decode_s[i], [&] {
                if (!level2::decode(raw, with_threads(request.threads[i]))) std::abort();
            });
        }
    }
    for (std::size_t i = 0; i < decode_s.size(); ++i) {
        const int threads = request.threads[i];
        const auto peak = peak_mib({"--decode-once", file.string(), std::to_string(threads)});
        table.add({{"file", file.filename().string()},
                   {"threads", threads},
                   {"libbz2_s", {libbz2_s, 4}},
                   {"decode_s", {decode_s[i], 4}},
                   {"ratio", {decode_s[i] / libbz2_s, 3}},
                   {"mb_per_s", {message_bytes / 1e6 / decode_s[i], 1}},
                   {"peak_mib", {peak.value_or(HUGE_VAL), 1}},
                   {"arrays_mib", {arrays, 1}},
                   {"file_mib", {static_cast<double>(raw.size()) / mebibyte, 1}}});
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
    const auto [request, status] =
        read_request({"bench_decode",
                      "[FILE ...]",
                      "what decoding costs beside libbz2 over the same LDM records",
                      {"--give-back"}},
                     std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return status;
    if (!request->has("--give-back")) keep_freed_memory();
    return measure_files("bench_decode", *request, measure);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
