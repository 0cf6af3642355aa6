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
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <bzlib.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/file_system.h"
#include "base/memory.h"
#include "level2/archive_header.h"
#include "level2/decode.h"
#include "level2/gzip_stream.h"
#include "level2/ldm_framer.h"

extern char** environ;

namespace stormcellar {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::byte>;

constexpr double mebibyte = 1024.0 * 1024.0;

template <class Work>
void keep_least_seconds(double& least, Work work) {
    const auto start = Clock::now();
    work();
    least = std::min(least, std::chrono::duration<double>(Clock::now() - start).count());
}

Bytes without_gzip(Bytes bytes) {
    if (!level2::is_gzip(bytes)) return bytes;
    level2::GzipStream gzip(bytes);
    Bytes inflated;
    for (auto piece = gzip.next(); !piece.empty(); piece = gzip.next())
        inflated.insert(inflated.end(), piece.begin(), piece.end());
    return inflated;
}

std::vector<std::span<const std::byte>> ldm_records(std::span<const std::byte> bytes) {
    const bool header = level2::read_archive_header(bytes).has_value();
    std::vector<std::span<const std::byte>> records;
    if (!level2::is_ldm_record(bytes.subspan(header ? level2::archive_header_bytes : 0))) return {};
    level2::LdmFramer framer(bytes);
    while (const auto part = framer.next()) {
        if (part->kind == level2::LdmPart::Kind::record) records.push_back(part->bytes);
    }
    return records;
}

// All of it, as the library's own example does: one stream, pieces of a buffer.
void decompress(std::span<const std::byte> record, std::vector<char>& buffer) {
    bz_stream stream{};
    if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) std::abort();
    // libbz2 does not write through next_in; its C interface merely lacks the const.
    stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(record.data()));
    stream.avail_in = static_cast<unsigned>(record.size());
    int code = BZ_OK;
    while (code == BZ_OK) {
        stream.next_out = buffer.data();
        stream.avail_out = static_cast<unsigned>(buffer.size());
        code = BZ2_bzDecompress(&stream);
        if (code == BZ_OK && stream.avail_in == 0 && stream.avail_out > 0) break;  // cut
    }
    BZ2_bzDecompressEnd(&stream);
}

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

// A whole number at the start of a text, behind spaces; -1 when there is none.
long number_in(std::string_view text) {
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t")));
    long number = -1;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

// What this process held at most, in KiB; the kernel's own count (proc(5)).
long high_water_kib() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return number_in(std::string_view{line}.substr(6));
    }
    return -1;
}

// In another process, so that nothing else is counted: this program with --decode-once.
std::optional<double> peak_mib(const fs::path& file, int threads) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) return {};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    std::string own = "/proc/self/exe", mode = "--decode-once", name = file.string(),
                count = std::to_string(threads);
    std::array<char*, 5> argv = {own.data(), mode.data(), name.data(), count.data(), nullptr};
    pid_t child = 0;
    const int failed = ::posix_spawn(&child, own.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    std::array<char, 32> text{};
    const ssize_t length = failed == 0 ? ::read(ends[0], text.data(), text.size() - 1) : 0;
    ::close(ends[0]);
    if (failed != 0) return {};
    int status = 0;
    ::waitpid(child, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || length <= 0) return {};
    return static_cast<double>(number_in(text.data())) / 1024;
}

void measure(const fs::path& file, int runs) {
    const auto raw = read_file(file);
    if (!raw) {
        fmt::print(stderr, "{}\n", raw.error().message);
        return;
    }
    const Bytes peeled = without_gzip(*raw);
    const auto records = ldm_records(peeled);
    if (records.empty()) return;
    const auto decoded = level2::decode(*raw);
    if (!decoded) return;
    const auto message_bytes = static_cast<double>(decoded->report.message_bytes);
    const double arrays = arrays_mib(decoded->volume);
    std::vector<char> buffer(std::size_t{1} << 20);
    double libbz2_s = HUGE_VAL;
    std::array<double, 2> decode_s = {HUGE_VAL, HUGE_VAL};
    for (int run = 0; run < runs; ++run) {
        keep_least_seconds(libbz2_s, [&] {
            for (const auto record : records)
                decompress(record, buffer);
        });
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
                   message_bytes / 1e6 / seconds, peak_mib(file, threads).value_or(-1), arrays,
                   static_cast<double>(raw->size()) / mebibyte);
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

std::vector<fs::path> real_volumes() {
    const char* given = std::getenv("STORMCELLAR_DATA");
    const fs::path data = given != nullptr ? given : "../shared/data";
    std::vector<fs::path> files;
    for (const char* folder : {"volumes", "sequence-kbgm", "mosaic-northeast"}) {
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(data / folder, ignored))
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

int run(int argc, char** argv) {
    if (argc == 4 && std::string(argv[1]) == "--decode-once") {
        keep_freed_memory();
        return decode_once(argv[2], argv[3]);
    }
    int runs = 5;
    bool give_back = false;
    std::vector<fs::path> files;
    for (int i = 1; i < argc; ++i) {
        if (std::string(argv[i]) == "--runs" && i + 1 < argc) {
            runs = std::max(1, static_cast<int>(number_in(argv[++i])));
        } else if (std::string(argv[i]) == "--give-back") {
            give_back = true;
        } else {
            files.emplace_back(argv[i]);
        }
    }
    if (!give_back) keep_freed_memory();
    if (files.empty()) files = real_volumes();
    if (files.empty()) {
        fmt::print(stderr, "bench_decode: no files: name some, or set STORMCELLAR_DATA\n");
        return 3;
    }
    fmt::print(
        "file\tthreads\tlibbz2_s\tdecode_s\tratio\tmb_per_s\tpeak_mib\tarrays_mib\tfile_mib\n");
    for (const fs::path& file : files)
        measure(file, runs);
    return 0;
}

}  // namespace
}  // namespace stormcellar

int main(int argc, char** argv) {
    return stormcellar::run(argc, argv);
}
