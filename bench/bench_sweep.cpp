// bench_sweep: measures the time from the close of the last chunk of a sweep to the cached grid.
//
// Real volumes are sent to the real stormcellard record by record, on a machine that does nothing
// else. After each chunk the program waits until the daemon is idle. A chunk after which the grid
// of the station appears anew has completed a sweep (or the volume).
//   as         appended to one file that is closed each time, or one file for each chunk
//   sweeps     those with a grid, and those of the volume that have the moment
//   latency_*  from the close of the chunk to the rename of the grid, by this program's clock
//   bzip2_*    bunzip alone for that chunk, in this process
//   beyond_*   the difference of the two, chunk by chunk
// The last grid, at the end of the volume, is made of everything and synced; it is listed
// separately.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "bench/daemon_process.h"
#include "bench/grid_watch.h"
#include "bench/request.h"
#include "bench/sent_volume.h"
#include "bench/table.h"
#include "stormcellar/cache/grid_name.h"
#include "stormcellar/level2/decode.h"
#include "synth/replay_pieces.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* daemon_configuration =
    "[cache]\nbytes = \"1 GiB\"\n[ingest]\nspacing_km = 1.0\nextent_km = [460, 460]\n"
    "levels_km = \"0.5:16:0.5\"\n[log]\nlevel = \"warning\"\n";
constexpr double longest_wait_s = 3, rest_s = 0.25;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Shown {
    std::vector<double> latency_s, bzip2_s, beyond_s;
    double end_s = std::nan(""), end_beyond_s = std::nan("");
};

// Waits until nothing has appeared for a while. Returns the time of the last grid, if any.
std::optional<double> wait_for_grid(const GridWatch& watch, Clock::time_point closed) {
    std::optional<double> first_s;
    while (seconds_since(closed) < (first_s ? *first_s + rest_s : longest_wait_s)) {
        watch.wait(0.01);
        watch.read([&](std::string_view) {
            if (!first_s) first_s = seconds_since(closed);
        });
        if (!first_s && seconds_since(closed) > 2 * rest_s + 0.5) break;
    }
    return first_s;
}

Result<Shown> send(const SentPieces& volume, bool as_chunks, const fs::path& work) {
    DaemonProcess daemon(work);
    std::error_code error;
    fs::create_directories(daemon.drop() / volume.decoded.station, error);
    GridWatch watch;
    const std::vector<std::string> stations = {volume.decoded.station};
    const std::vector<std::string> days = {cache::day_name(volume.decoded.header->time())};
    if (Status watched = watch.watch(daemon.cache(), stations, days); !watched) {
        return pass_on(watched);
    }
    if (Status started = daemon.start(daemon_configuration); !started) return pass_on(started);
    Shown shown;
    const std::vector<std::size_t> ends = synth::piece_ends(volume.bytes);
    const fs::path directory = daemon.drop() / volume.decoded.station;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const bool is_last = i + 1 == ends.size();
        const auto piece = std::span{volume.bytes}.subspan(begin, ends[i] - begin);
        begin = ends[i];
        const fs::path path = directory / (as_chunks ? fs::path{chunk_name(volume, i + 1, is_last)}
                                                     : volume.path.filename());
        const auto closed = append_piece(path, piece);
        const auto latency_s = wait_for_grid(watch, closed);
        if (!latency_s) continue;
        const double bzip2_s = bzip2_of(piece);
        if (is_last) {
            shown.end_s = *latency_s;
            shown.end_beyond_s = *latency_s - bzip2_s;
            continue;
        }
        shown.latency_s.push_back(*latency_s);
        shown.bzip2_s.push_back(bzip2_s);
        shown.beyond_s.push_back(*latency_s - bzip2_s);
    }
    if (!daemon.stop()) return fail(ErrorCode::io, "the daemon did not end well");
    return shown;
}

void add_row(const SentPieces& volume, bool as_chunks, const Shown& shown, Table& table) {
    const auto sweeps = std::count_if(
        volume.decoded.sweeps.begin(), volume.decoded.sweeps.end(),
        [](const level2::Sweep& sweep) { return sweep.find(level2::Moment::ref) != nullptr; });
    const auto ms = [](double seconds) { return Cell{seconds * 1000, 1}; };
    table.add({{"volume", volume.path.filename().string()},
               {"as", as_chunks ? "chunks" : "growing"},
               {"sweeps", fmt::format("{} of {}", shown.latency_s.size() + 1, sweeps)},
               {"latency_p50_ms", ms(quantile(shown.latency_s, 0.5))},
               {"latency_max_ms", ms(quantile(shown.latency_s, 1))},
               {"bzip2_p50_ms", ms(quantile(shown.bzip2_s, 0.5))},
               {"beyond_p50_ms", ms(quantile(shown.beyond_s, 0.5))},
               {"beyond_p95_ms", ms(quantile(shown.beyond_s, 0.95))},
               {"beyond_max_ms", ms(quantile(shown.beyond_s, 1))},
               {"end_ms", ms(shown.end_s)},
               {"end_beyond_ms", ms(shown.end_beyond_s)}});
}

void measure(const fs::path& path, const Request& request, Table& table) {
    const auto volume = read_sent_volume(path);
    if (!volume) {
        fmt::print(stderr, "bench_sweep: {}\n", volume.error().message);
        return;
    }
    const fs::path root =
        fs::path{request.value("--work").value_or(fs::temp_directory_path().string())} /
        fmt::format("bench-sweep-{}", ::getpid());
    for (const bool as_chunks : {false, true}) {
        const auto shown = send(*volume, as_chunks, root);
        std::error_code error;
        fs::remove_all(root, error);
        if (shown) {
            add_row(*volume, as_chunks, *shown, table);
        } else {
            fmt::print(stderr, "bench_sweep: {}\n", shown.error().message);
        }
    }
}

int run(int argc, char** argv) {
    const auto arguments = std::span(argv, static_cast<std::size_t>(argc));
    return run_over_files({"bench_sweep",
                           "[FILE ...]",
                           "from the close of a chunk to its sweep in the cached grid; --work DIR",
                           {},
                           {"--work"}},
                          arguments, measure);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
