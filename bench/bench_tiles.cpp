// bench_tiles: how long a tile of the data server takes, of a site's grid and of a national mosaic.
//
// usage: bench_tiles [--data DIR] [--tiles N] [--cache DIR] [--json] [FILE]
//   (bench/request.h; a busy volume unless one is named; 20 tiles a row; with --cache, the mosaic
//   stays in that directory for the next time)
// `stormcellar serve` has the site's grids, and then a cache with 7000 x 3500 x 33 cells of the
// United States (bench/us_storms.h). One client asks for one tile at a time, each by a connection
// of its own. There is a row for each product of reflectivity and zoom:
//   what      domain and layer
//   zoom      of the tiles; those about the middle of the domain
//   first_ms  the first tile of the layer, for which the product and its overviews are made; "-" in
//             later rows of the layer
//   cold_p50_ms, cold_max_ms  tiles that nobody asked for before
//   kept_p50_ms               the same tiles again
//   peak_mib                  resident memory of the server since its start
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bench/measure.h"
#include "bench/request.h"
#include "bench/table.h"
#include "bench/us_mosaic.h"
#include "bench/web_load.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/render/product.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

struct TileRow {
    std::string domain, layer;
    double latitude_deg = 0, longitude_deg = 0;
    int zoom = 0;
};

// The tiles of a zoom in the order of their distance from the place's.
std::vector<std::string> paths_about(const TileRow& row, std::size_t count) {
    const double tiles = std::exp2(row.zoom);
    const double latitude = row.latitude_deg * M_PI / 180;
    const int column = static_cast<int>(tiles * (row.longitude_deg + 180) / 360);
    const int middle = static_cast<int>(tiles * (1 - std::asinh(std::tan(latitude)) / M_PI) / 2);
    std::vector<std::string> paths;
    const int most = static_cast<int>(tiles) - 1;
    for (int ring = 0; paths.size() < count && ring <= most; ++ring) {
        for (int y = middle - ring; y <= middle + ring; ++y) {
            for (int x = column - ring; x <= column + ring; ++x) {
                const bool on_ring = std::max(std::abs(x - column), std::abs(y - middle)) == ring;
                if (!on_ring || x < 0 || y < 0 || x > most || y > most || paths.size() == count)
                    continue;
                paths.push_back(fmt::format("/tiles/{}/{}/latest/{}/{}/{}.png", row.domain,
                                            row.layer, row.zoom, x, y));
            }
        }
    }
    return paths;
}

class TileBench {
  public:
    TileBench(WebServer server, fs::path scratch, Table& table)
        : server_(std::move(server)), scratch_(std::move(scratch)), table_(table) {}

    Status measure(const TileRow& row, std::size_t count) {
        double first_ms = std::numeric_limits<double>::quiet_NaN();
        const std::string layer = row.domain + " " + row.layer;
        if (layer != last_layer_) {
            const auto first = time_of(paths_about(row, 1).front() + "?smooth=cubic");
            if (!first) return pass_on(first);
            first_ms = *first;
            last_layer_ = layer;
        }
        const auto paths = paths_about(row, count);
        const auto cold = times_of(paths);
        if (!cold) return pass_on(cold);
        const auto kept = times_of(paths);
        if (!kept) return pass_on(kept);
        table_.add({{"what", layer},
                    {"zoom", row.zoom},
                    {"first_ms", Cell{first_ms, 1}},
                    {"cold_p50_ms", Cell{(*cold)[cold->size() / 2], 1}},
                    {"cold_max_ms", Cell{cold->back(), 1}},
                    {"kept_p50_ms", Cell{(*kept)[kept->size() / 2], 2}},
                    {"peak_mib", Cell{server_.process.peak_mib(), 0}}});
        return {};
    }

  private:
    Result<double> time_of(const std::string& path) {
        const auto fetched = get(server_.address() + path, {}, scratch_);
        if (!fetched) return pass_on(fetched);
        if (fetched->status != 200)
            return fail(ErrorCode::internal, "{} answered {}", path, fetched->status);
        return fetched->ms;
    }
    // In rising order.
    Result<std::vector<double>> times_of(const std::vector<std::string>& paths) {
        std::vector<double> times;
        for (const std::string& path : paths) {
            const auto time = time_of(path);
            if (!time) return pass_on(time);
            times.push_back(*time);
        }
        std::sort(times.begin(), times.end());
        return times;
    }

    WebServer server_;
    fs::path scratch_;
    Table& table_;
    std::string last_layer_;
};

// Commits the national mosaic to a cache.
Status fill(const fs::path& cache) {
    auto store = cache::StoreWriter::open(real_file_system(), cache, false);
    if (!store) return pass_on(store);
    const auto nation = us_mosaic();
    if (!nation) return pass_on(nation);
    cache::GridDescription description;
    description.spec = nation->spec();
    description.time = description.start_time = description.end_time =
        UtcTime{std::chrono::sys_days{std::chrono::year{2020} / 6 / 1}};
    const auto written = store->commit("US", description, nation->view());
    if (!written) return pass_on(written);
    return {};
}

Status measure_rows(Result<WebServer> server, const TileRow& place,
                    std::span<const std::string_view> layers, std::span<const int> zooms,
                    std::size_t count, const fs::path& scratch, Table& table) {
    if (!server) return pass_on(server);
    TileBench bench(std::move(*server), scratch, table);
    for (const std::string_view layer : layers) {
        for (const int zoom : zooms) {
            TileRow row = place;
            row.layer = layer;
            row.zoom = zoom;
            if (Status measured = bench.measure(row, count); !measured) return measured;
        }
    }
    return {};
}

Status measure_all(const fs::path& file, std::size_t count, const fs::path& cache,
                   const fs::path& scratch, Table& table) {
    std::vector<std::string_view> layers;
    for (const render::ProductFacts& facts : render::all_products())
        if (facts.view == render::View::map && !facts.is_of_sweep) layers.push_back(facts.name);
    const std::string site = file.filename().native().substr(0, 4);
    const auto station = find_station(site);
    if (!station)
        return fail(ErrorCode::bad_argument, "{}: the name begins with no station", file.native());
    constexpr std::array site_zooms{6, 8, 10};
    Status status = measure_rows(serve_files({file}, scratch),
                                 {site, {}, station->latitude_deg, station->longitude_deg}, layers,
                                 site_zooms, count, scratch, table);
    if (!status) return status;
    if (!fs::exists(cache / "US"))
        if (status = fill(cache); !status) return status;
    constexpr std::array nation_zooms{4, 6, 8, 10};
    return measure_rows(serve_files({"--cache", cache}, scratch), {"US", {}, 37.5, -95}, layers,
                        nation_zooms, count, scratch, table);
}

std::optional<fs::path> file_of(const Request& request) {
    for (const fs::path& file : request.volumes())
        if (!request.files.empty() || file.filename().native().starts_with("KLBB2016")) return file;
    return std::nullopt;
}

int run(const Request& request) {
    const auto file = file_of(request);
    if (!file) {
        fmt::print(stderr, "bench_tiles: there is no volume; name one, or set STORMCELLAR_DATA\n");
        return 3;
    }
    std::string pattern = (fs::temp_directory_path() / "bench_tiles.XXXXXX").native();
    if (::mkdtemp(pattern.data()) == nullptr) return 1;
    const fs::path scratch = pattern;
    const auto count =
        static_cast<std::size_t>(std::stoul(request.value("--tiles").value_or("20")));
    Table table(request.json);
    const fs::path cache = request.value("--cache").value_or((scratch / "cache").native());
    const Status status = measure_all(*file, count, cache, scratch, table);
    table.finish();
    std::error_code ignored;
    fs::remove_all(scratch, ignored);
    if (!status) {
        fmt::print(stderr, "bench_tiles: {}\n", status.error().message);
        return 1;
    }
    return 0;
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    namespace bench = stormcellar::bench;
    const bench::Program program{
        .name = "bench_tiles",
        .files = "[FILE]",
        .purpose = "how long a tile takes, of a site and of the United States; --tiles N",
        .values = {"--tiles", "--cache"}};
    const auto read = bench::read_request(program, std::span(argv, static_cast<std::size_t>(argc)));
    return read.request ? bench::run(*read.request) : read.status;
}
