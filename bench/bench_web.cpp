// bench_web: measures how much the data server serves in a second, compared with nginx, and how
// soon it draws tiles.
//
// usage: bench_web [--data DIR] [--seconds N] [--clients "1 64"] [--json]
//        [--tiles [--requests 20] [--cache DIR]] [FILE ...]      (bench/request.h)
// `stormcellar serve` with the files (by default one busy volume) and nginx take turns on one
// processor, while wrk runs on another. The measurement begins when all grids of the files are
// made. A row takes --seconds N (5). There is a row for each kind of request and number of clients:
//   what            kind of request, and server
//   clients         number of open connections
//   requests_per_s  answers a second
//   mb_per_s        10^6 bytes of answers a second, with headers
//   p50_ms, p99_ms  median and 99th percentile of the time from request to end of answer
//   cpu_cores       CPU time of the server divided by wall time
//   peak_mib        peak resident memory of the server since its start
//   failed          number of requests without an answer or with an error
//   of_nginx        requests_per_s divided by that of nginx in the previous row; "-" without such a
//                   row
// In "first" rows one client makes one request of each kind; p50_ms is the median of their times,
// p99_ms the longest.
//
// --tiles: instead, one client requests tiles one by one, --requests of each zoom, from the center
// of the domain outward. The client requests the tiles from `stormcellar serve` with a file, and
// then with the cache DIR of the domain US (bench_mosaic --us --cache):
//   what            domain, layer and zoom
//   first_ms        time of the layer's first tile, which makes the product and its overviews
//   new_p50_ms, new_max_ms  median and longest time of tiles that were not requested before
//   kept_p50_ms     median time of the same tiles when requested again
//   peak_mib        peak resident memory of the server since its start
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "bench/web_load.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/render/product.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
const std::vector<std::string> gzip = {"Accept-Encoding: gzip"};

std::vector<double> times_of(const std::vector<Fetched>& all) {
    std::vector<double> times_ms;
    for (const Fetched& one : all)
        times_ms.push_back(one.ms);
    return times_ms;
}

struct Asked {
    std::string what, path;
    std::vector<std::string> headers;
};

class WebBench {
  public:
    WebBench(WebServer ours, fs::path scratch, Table& table)
        : ours_(std::move(ours)), scratch_(std::move(scratch)), table_(table) {}

    // Requests each path once, and keeps the time of each.
    Status ask_first(const std::string& what, const std::vector<std::string>& paths,
                     const std::vector<std::string>& headers) {
        const auto fetched = get_all(ours_, paths, headers, scratch_);
        if (!fetched) return pass_on(fetched);
        Load figures;
        figures.p50_ms = quantile(times_of(*fetched), 0.5);
        figures.p99_ms = quantile(times_of(*fetched), 1);
        figures.requests_per_s = figures.mb_per_s = figures.cpu_cores = none;
        add(what + ", first", 1, ours_, figures, none);
        return {};
    }

    // Loads nginx, which serves the same bytes as a file, and then our server.
    Status compare(const Asked& asked, const std::vector<int>& clients, std::chrono::seconds time) {
        std::string body;
        const auto fetched = get_all(ours_, {asked.path}, asked.headers, scratch_, &body);
        if (!fetched) return pass_on(fetched);
        const fs::path files = scratch_ / "files";
        fs::create_directories(files);
        std::ofstream(files / "same", std::ios::binary) << body;
        auto nginx = serve_with_nginx(files, scratch_);
        if (!nginx) return pass_on(nginx);
        for (const int count : clients) {
            const auto theirs = load(*nginx, "/same", asked.headers, count, time, scratch_);
            if (!theirs) return pass_on(theirs);
            add(asked.what + ", nginx", count, *nginx, *theirs, none);
            const auto figures = load(ours_, asked.path, asked.headers, count, time, scratch_);
            if (!figures) return pass_on(figures);
            add(asked.what, count, ours_, *figures,
                figures->requests_per_s / theirs->requests_per_s);
        }
        return {};
    }

    // Returns the paths of the server's grids: "/api/v1/grids/DOMAIN/MOMENT/TIME/packed".
    Result<std::vector<std::string>> packed_grids() {
        std::string body;
        const auto fetched = get_all(ours_, {"/api/v1/grids"}, {}, scratch_, &body);
        if (!fetched) return pass_on(fetched);
        std::vector<std::string> paths;
        const auto listed = nlohmann::json::parse(body);
        for (const auto& grid : listed["grids"]) {
            paths.push_back(
                fmt::format("/api/v1/grids/{}/{}/{}/packed", grid["domain"].get<std::string>(),
                            grid["moment"].get<std::string>(), grid["time"].get<std::string>()));
        }
        return paths;
    }

  private:
    void add(const std::string& what, int clients, const WebServer& server, const Load& figures,
             double of_nginx) {
        table_.add({{"what", what},
                    {"clients", clients},
                    {"requests_per_s", Cell{figures.requests_per_s, 0}},
                    {"mb_per_s", Cell{figures.mb_per_s, 1}},
                    {"p50_ms", Cell{figures.p50_ms, 2}},
                    {"p99_ms", Cell{figures.p99_ms, 2}},
                    {"cpu_cores", Cell{figures.cpu_cores, 2}},
                    {"peak_mib", Cell{server.process.memory_mib(), 0}},
                    {"failed", static_cast<int>(figures.failed)},
                    {"of_nginx", Cell{of_nginx, 2}}});
    }

    WebServer ours_;
    fs::path scratch_;
    Table& table_;
};

std::vector<int> numbers_in(const std::string& text) {
    std::istringstream words(text);
    std::vector<int> numbers;
    for (int number = 0; words >> number;)
        numbers.push_back(number);
    return numbers;
}

std::size_t number_of(const Request& request, std::string_view option, std::size_t usual) {
    const auto text = request.value(option);
    return text ? static_cast<std::size_t>(std::max(1, std::atoi(text->c_str()))) : usual;
}

// Waits until the server has made all grids of its files. The server listens before that, and
// gridding would take the processor from the requests that are measured.
Status wait_for_grids(Result<WebServer>& server) {
    if (!server) return pass_on(server);
    if (server->process.wait_until_idle(std::chrono::minutes{10})) return {};
    return fail(ErrorCode::not_found, "stormcellar serve did not finish its grids");
}

Status measure_load(const std::vector<fs::path>& files, const Request& request,
                    const fs::path& scratch, Table& table) {
    auto ours = serve({files.begin(), files.end()}, scratch, processor_of_servers);
    if (Status idle = wait_for_grids(ours); !idle) return idle;
    WebBench bench(std::move(*ours), scratch, table);
    const auto packed = bench.packed_grids();
    if (!packed) return pass_on(packed);
    const auto reflectivity = std::ranges::find_if(
        *packed, [](const auto& path) { return path.find("/REF/") != std::string::npos; });
    if (reflectivity == packed->end())
        return fail(ErrorCode::not_found, "no grid of reflectivity could be made of the files");
    if (Status first = bench.ask_first("packed grid, gzip", *packed, gzip); !first) return first;
    if (Status first = bench.ask_first("packed grid, plain", *packed, {}); !first) return first;
    const std::string name = files.front().filename();
    const std::vector<Asked> kept = {
        {"packed grid, gzip", *reflectivity, gzip},
        {"packed grid, plain", *reflectivity, {}},
        {"raw volume", fmt::format("/volumes/{}/{}", name.substr(0, 4), name), {}},
        {"list of stations", "/api/v1/stations", {}},
    };
    const std::chrono::seconds time{number_of(request, "--seconds", 5)};
    const auto clients = numbers_in(request.value("--clients").value_or("1 64"));
    for (const Asked& asked : kept)
        if (Status compared = bench.compare(asked, clients, time); !compared) return compared;
    return {};
}

struct TilePlace {
    std::string domain;
    double latitude_deg = 0, longitude_deg = 0;
    std::vector<int> zooms;
};

// Returns `count` tiles of a zoom level, from the tile of the place outward.
std::vector<std::string> tiles_about(const TilePlace& place, std::string_view layer, int zoom,
                                     std::size_t count) {
    const double tiles = std::exp2(zoom);
    const double latitude = place.latitude_deg * M_PI / 180;
    const int column = static_cast<int>(tiles * (place.longitude_deg + 180) / 360);
    const int middle = static_cast<int>(tiles * (1 - std::asinh(std::tan(latitude)) / M_PI) / 2);
    std::vector<std::string> paths;
    const int most = static_cast<int>(tiles) - 1;
    for (int ring = 0; paths.size() < count && ring <= most; ++ring) {
        for (int y = std::max(0, middle - ring); y <= std::min(most, middle + ring); ++y) {
            for (int x = std::max(0, column - ring); x <= std::min(most, column + ring); ++x) {
                const bool on_ring = std::max(std::abs(x - column), std::abs(y - middle)) == ring;
                if (on_ring && paths.size() < count)
                    paths.push_back(fmt::format("/tiles/{}/{}/latest/{}/{}/{}.png", place.domain,
                                                layer, zoom, x, y));
            }
        }
    }
    return paths;
}

Status measure_tiles_of(const TilePlace& place, Result<WebServer> server, std::size_t count,
                        const fs::path& scratch, Table& table) {
    if (Status idle = wait_for_grids(server); !idle) return idle;
    for (const render::ProductFacts& facts : render::all_products()) {
        if (facts.view != render::View::map || facts.is_of_sweep) continue;
        const auto first = get_all(
            *server,
            {tiles_about(place, facts.name, place.zooms.front(), 1).front() + "?smooth=cubic"}, {},
            scratch);
        if (!first) return pass_on(first);
        for (const int zoom : place.zooms) {
            const auto paths = tiles_about(place, facts.name, zoom, count);
            const auto fresh = get_all(*server, paths, {}, scratch);
            if (!fresh) return pass_on(fresh);
            const auto kept = get_all(*server, paths, {}, scratch);
            if (!kept) return pass_on(kept);
            table.add({{"what", fmt::format("{} {}, zoom {}", place.domain, facts.name, zoom)},
                       {"first_ms", Cell{first->front().ms, 1}},
                       {"new_p50_ms", Cell{quantile(times_of(*fresh), 0.5), 1}},
                       {"new_max_ms", Cell{quantile(times_of(*fresh), 1), 1}},
                       {"kept_p50_ms", Cell{quantile(times_of(*kept), 0.5), 2}},
                       {"peak_mib", Cell{server->process.memory_mib(), 0}}});
        }
    }
    return {};
}

Status measure_tiles(const fs::path& file, const Request& request, const fs::path& scratch,
                     Table& table) {
    const auto station = find_station(file.filename().native().substr(0, 4));
    if (!station)
        return fail(ErrorCode::bad_argument, "{}: the name begins with no station", file.native());
    const std::size_t count = number_of(request, "--requests", 20);
    const TilePlace site{
        std::string(station->icao), station->latitude_deg, station->longitude_deg, {6, 8, 10}};
    Status status = measure_tiles_of(site, serve({file}, scratch), count, scratch, table);
    const auto cache = request.value("--cache");
    if (!status || !cache) return status;
    return measure_tiles_of({"US", 37.5, -95, {4, 6, 8, 10}}, serve({"--cache", *cache}, scratch),
                            count, scratch, table);
}

std::vector<fs::path> files_of(const Request& request) {
    if (!request.files.empty()) return request.files;
    for (const fs::path& file : request.volumes()) {
        if (file.filename().native().starts_with("KLBB2016")) return {file};
    }
    return {};
}

int run(const Request& request) {
    const auto files = files_of(request);
    if (files.empty()) {
        fmt::print(stderr, "bench_web: there are no volumes; name one, or set STORMCELLAR_DATA\n");
        return 3;
    }
    std::string pattern = (fs::temp_directory_path() / "bench_web.XXXXXX").native();
    if (::mkdtemp(pattern.data()) == nullptr) return 1;
    const fs::path scratch = pattern;
    Table table(request.json);
    const Status status = request.has("--tiles")
                              ? measure_tiles(files.front(), request, scratch, table)
                              : measure_load(files, request, scratch, table);
    table.finish();
    if (!status) {
        fmt::print(stderr, "bench_web: {}\n", status.error().message);
        return 1;
    }
    std::error_code ignored;
    fs::remove_all(scratch, ignored);
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    return stormcellar::bench::run_benchmark(
        {"bench_web",
         "[FILE ...]",
         "what the data server serves a second, beside nginx; --seconds N, --clients \"1 64\"; or "
         "how soon it lists an --archive or draws --tiles",
         {"--archive", "--tiles"},
         {"--seconds", "--clients", "--stations", "--rows", "--grids", "--requests", "--cache",
          "--work"}},
        argc, argv, stormcellar::bench::run);
}
