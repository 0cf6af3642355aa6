#include "bench/measure.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <utility>

#include <bzlib.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bunzip/bunzip.h"
#include "level2/containers/gzip_stream.h"
#include "level2/containers/ldm_framer.h"
#include "stormcellar/base/file_system.h"

extern char** environ;

namespace stormcellar::bench {
namespace {

void decompress(std::span<const std::byte> record, std::vector<char>& buffer) {
    bz_stream stream{};
    if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) std::abort();
    // libbz2 does not write through next_in; its C interface only lacks the const.
    stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(record.data()));
    stream.avail_in = static_cast<unsigned>(record.size());
    int code = BZ_OK;
    while (code == BZ_OK) {
        stream.next_out = buffer.data();
        stream.avail_out = static_cast<unsigned>(buffer.size());
        code = BZ2_bzDecompress(&stream);
        // the stream is cut
        if (code == BZ_OK && stream.avail_in == 0 && stream.avail_out > 0) break;
    }
    BZ2_bzDecompressEnd(&stream);
}

enum class Stderr { shown, dropped };

// From the program's start to its end. None where it failed.
std::optional<ProgramRun> run_program(std::string program, std::vector<std::string> arguments,
                                      Stderr errors) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) return {};
    std::vector<char*> argv = {program.data()};
    for (std::string& argument : arguments)
        argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    if (errors == Stderr::dropped)
        posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    int status = -1;
    ProgramRun run;
    run.seconds = seconds_of([&] {
        pid_t child = 0;
        if (::posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ) == 0) {
            ::waitpid(child, &status, 0);
        }
    });
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    run.said.resize(std::size_t{1} << 16);  // what a pipe holds
    const ssize_t length = ::read(ends[0], run.said.data(), run.said.size());
    ::close(ends[0]);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || length < 0) return {};
    run.said.resize(static_cast<std::size_t>(length));
    return run;
}

}  // namespace

std::vector<std::span<const std::byte>> ldm_records(const Bytes& file, Bytes& peeled) {
    peeled = level2::without_gzip(file);
    return level2::ldm_records(peeled);
}

std::optional<RecordFile> read_records(const std::filesystem::path& path) {
    auto raw = read_file(path);
    if (!raw) {
        fmt::print(stderr, "{}\n", raw.error().message);
        return std::nullopt;
    }
    RecordFile file;
    file.raw = std::move(*raw);
    file.records = ldm_records(file.raw, file.peeled);
    return file;
}

void decompress_all(std::span<const std::span<const std::byte>> records) {
    std::vector<char> buffer(std::size_t{1} << 20);
    for (const auto record : records)
        decompress(record, buffer);
}

void bunzip_all(std::span<const std::span<const std::byte>> records) {
    bunzip::Workspace workspace;
    std::vector<std::byte> buffer(std::size_t{1} << 20);
    for (const auto record : records) {
        bunzip::Reader reader(record, workspace);
        while (!reader.ended())
            static_cast<void>(reader.read(buffer));
    }
}

double cpu_s() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

long number_in(std::string_view text) {
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(" \t")));
    long number = -1;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

long high_water_kib() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) return number_in(std::string_view{line}.substr(6));
    }
    return -1;
}

std::optional<std::string> run_self(std::vector<std::string> arguments) {
    auto run = run_program("/proc/self/exe", std::move(arguments), Stderr::shown);
    if (!run || run->said.empty()) return {};
    return std::move(run->said);
}

std::optional<double> peak_mib(std::vector<std::string> arguments) {
    const auto said = run_self(std::move(arguments));
    if (!said) return {};
    return static_cast<double>(number_in(*said)) / 1024;
}

std::optional<ProgramRun> run_stormcellar(std::vector<std::string> arguments) {
    std::error_code failed;
    const auto own = std::filesystem::read_symlink("/proc/self/exe", failed);
    if (failed) return {};
    return run_program(own.parent_path().parent_path() / "cli" / "stormcellar",
                       std::move(arguments), Stderr::dropped);
}

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return std::nan("");
    std::sort(values.begin(), values.end());
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return values[std::max<std::size_t>(1, static_cast<std::size_t>(rank)) - 1];
}

}  // namespace stormcellar::bench
