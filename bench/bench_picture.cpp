// bench_picture: where the time of `stormcellar frame FILE` goes, from its start to the file, and
// what smooth tables, light and smoothed maps add.
//
// usage: bench_picture [--data DIR] [--threads N] [--runs N] [--json] [FILE ...]
//   (bench/request.h; two busy volumes, unless files are named)
// There is a row for each file, picture and number of threads:
//   file       its name
//   picture    what is drawn, by the table at the head of this program
//   threads    for decoding, gridding and drawing
//   start_ms   the loader, the options, and the end of the process
//   decode_ms  reading and decoding the file
//   grid_ms    gridding, making bricks of the grid, and fitting the view to the echo
//   draw_ms    drawing, light and labels included
//   encode_ms  encoding the PNG and writing it
//   whole_ms   the process from its start to its end
// All are of the run whose whole_ms is least. In each run, all pictures are made one after the
// other.
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/render/product.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

struct Drawn {
    const char* name;
    std::vector<std::string> options;
};

// Each volume and each map differs from the one before by one thing. The map is that of the column
// maximum.
const std::vector<Drawn>& pictures() {
    static const std::string map{render::product_name(render::Product::composite)};
    static const std::vector<Drawn> all = {
        {"volume, nws, unlit", {"--colors", "nws", "--light", "none"}},
        {"volume, smooth, unlit", {"--light", "none"}},
        {"volume, gradient", {"--light", "gradient"}},
        {"volume, default", {}},
        {"map, cells", {"--product", map, "--smooth", "none"}},
        {"map, default", {"--product", map}},
    };
    return all;
}

struct Stages {
    double whole_ms = std::numeric_limits<double>::infinity();
    double start_ms = 0, decode_ms = 0, grid_ms = 0, draw_ms = 0, encode_ms = 0;
};

Stages stages_of(const ProgramRun& run) {
    const auto said = nlohmann::json::parse(run.said, nullptr, false);
    const auto ms = [&](const char* key) {
        return said.is_object() && said.contains(key) ? 1e3 * said[key].get<double>()
                                                      : std::nan("");
    };
    Stages stages;
    stages.whole_ms = 1e3 * run.seconds;
    stages.start_ms = stages.whole_ms - ms("total_s");
    stages.decode_ms = ms("decode_s");
    stages.grid_ms = ms("read_s") - stages.decode_ms;
    stages.draw_ms = ms("render_s");
    stages.encode_ms = ms("write_s");
    return stages;
}

void measure(const fs::path& file, const Request& request, Table& table) {
    const fs::path output =
        fs::temp_directory_path() / fmt::format("bench_picture.{}.png", ::getpid());
    for (const int threads : request.threads) {
        std::vector<Stages> least(pictures().size());
        for (int run = 0; run < request.runs; ++run) {
            for (std::size_t i = 0; i < pictures().size(); ++i) {
                std::vector<std::string> words = {
                    "frame",     file.string(),          "-o", output.string(), "--json",
                    "--threads", std::to_string(threads)};
                const auto& own = pictures()[i].options;
                words.insert(words.end(), own.begin(), own.end());
                const auto made = run_stormcellar(std::move(words));
                if (made && 1e3 * made->seconds < least[i].whole_ms) least[i] = stages_of(*made);
            }
        }
        for (std::size_t i = 0; i < pictures().size(); ++i) {
            const Stages& stages = least[i];
            table.add({{"file", file.filename().string()},
                       {"picture", pictures()[i].name},
                       {"threads", threads},
                       {"start_ms", {stages.start_ms, 0}},
                       {"decode_ms", {stages.decode_ms, 0}},
                       {"grid_ms", {stages.grid_ms, 0}},
                       {"draw_ms", {stages.draw_ms, 0}},
                       {"encode_ms", {stages.encode_ms, 0}},
                       {"whole_ms", {stages.whole_ms, 0}}});
        }
    }
    std::error_code ignored;
    fs::remove(output, ignored);
}

int run(int argc, char** argv) {
    const Program program{"bench_picture", "[FILE ...]",
                          "where the time of `stormcellar frame FILE` goes"};
    auto [request, usage_status] =
        read_request(program, std::span(argv, static_cast<std::size_t>(argc)));
    if (!request) return usage_status;
    if (request->files.empty()) {
        for (const char* name : {"KLBB20160601_150025_V06", "KTLX19990503_235621.gz"})
            request->files.push_back(request->data_directory() / "volumes" / name);
    }
    return measure_files(program.name, *request, measure);
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run(argc, argv);
}
