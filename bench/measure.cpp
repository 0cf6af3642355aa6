#include "bench/measure.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <utility>

#include <bzlib.h>
#include <fmt/format.h>
#include <unistd.h>

#include "bench/process.h"
#include "bunzip/bunzip.h"
#include "level2/containers/gzip_stream.h"
#include "level2/containers/ldm_framer.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"

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

Result<level2::Volume> decode_ref(const Bytes& bytes, std::string_view name, int threads) {
    level2::DecodeOptions options;
    const std::string station(name.substr(0, 4));
    if (find_station(station)) options.fallback_station = station;
    options.threads = threads;
    options.selection.moments = {level2::Moment::ref};
    auto decoded = level2::decode(bytes, options);
    if (!decoded) return pass_on(decoded);
    return std::move(decoded->volume);
}

Result<level2::Volume> decode_ref(const std::filesystem::path& file, int threads) {
    const auto bytes = read_file(file);
    if (!bytes) return pass_on(bytes);
    return decode_ref(*bytes, file.filename().native(), threads);
}

Result<grid::SitePosition> site_of(const level2::Volume& volume) {
    if (const auto antenna = level2::antenna_position(volume)) {
        return grid::SitePosition{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    }
    if (const auto station = find_station(volume.station)) return position_of(*station);
    return fail(ErrorCode::not_found, "no position");
}

grid::SitePosition position_of(const Station& station) {
    return {std::string(station.icao), station.latitude_deg, station.longitude_deg,
            station.antenna_altitude_m};
}

std::string built_program(const std::filesystem::path& program) {
    std::error_code failed;
    const auto own = std::filesystem::read_symlink("/proc/self/exe", failed);
    return own.parent_path().parent_path() / program;
}

std::optional<ProgramRun> run_program(const std::string& program,
                                      std::vector<std::string> arguments) {
    const std::filesystem::path output =
        std::filesystem::temp_directory_path() / fmt::format("stormcellar-bench-{}", ::getpid());
    arguments.insert(arguments.begin(), program);
    ProgramRun run;
    bool good = false;
    run.seconds = seconds_of([&] {
        auto child = ChildProcess::start(std::move(arguments), output);
        good = child && child->wait();
    });
    const std::string errors = output.native() + ".err";
    if (good) {
        run.said = text_in(output);
    } else {
        fmt::print(stderr, "{} failed: {}\n", program, text_in(errors));
    }
    std::error_code ignored;
    std::filesystem::remove(output, ignored);
    std::filesystem::remove(errors, ignored);
    if (!good) return {};
    return run;
}

std::optional<std::string> run_self(std::vector<std::string> arguments) {
    auto run = run_program("/proc/self/exe", std::move(arguments));
    if (!run || run->said.empty()) return {};
    return std::move(run->said);
}

double peak_mib(std::vector<std::string> arguments) {
    const auto said = run_self(std::move(arguments));
    return said ? static_cast<double>(number_in(*said)) / 1024 : std::nan("");
}

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return std::nan("");
    std::sort(values.begin(), values.end());
    const double rank = std::ceil(share * static_cast<double>(values.size()));
    return values[std::max<std::size_t>(1, static_cast<std::size_t>(rank)) - 1];
}

}  // namespace stormcellar::bench
