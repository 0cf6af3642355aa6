#include "bench/us_mosaic.h"

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/file_system.h"
#include "base/station_table.h"
#include "bench/merge_case.h"
#include "bench/us_storms.h"
#include "cache/grid_file.h"
#include "grid/projection.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_sites = 160;

struct PlacedSite {
    grid::SitePosition site;
    grid::GridWindow window;
};

// The newcomer's first, then those that stand within the domain.
std::vector<PlacedSite> sites_of(const grid::GridSpec& domain, const Newcomer& newcomer) {
    std::vector<PlacedSite> sites = {{newcomer.site, newcomer.window}};
    const grid::GridProjection projection(domain);
    for (const Station& station : all_stations()) {
        if (sites.size() == most_sites) break;
        const grid::SitePosition site = position_of(station);
        const auto window = grid::site_window(domain, site);
        const auto column = projection.to_column({site.latitude_deg, site.longitude_deg});
        const bool inside =
            column.x > 0 && column.x < domain.nx && column.y > 0 && column.y < domain.ny;
        if (!window || !inside || site.icao == newcomer.site.icao) continue;
        sites.push_back({site, *window});
    }
    return sites;
}

Result<cache::GridFile> partial_file(const grid::GridSpec& domain, const PlacedSite& placed,
                                     const grid::SiteDistance& distance, const fs::path& work) {
    const fs::path path = work / fmt::format("{}.grid", placed.site.icao);
    auto there = cache::GridFile::open(path);
    if (there) return there;
    const grid::BrickGrid made = us_storms(domain, placed.window, distance, placed.site);
    cache::GridDescription description;
    description.spec = made.spec();
    description.sites = {placed.site};
    const auto written = cache::write_grid_file(real_file_system(), path, description, made.view());
    if (!written) return pass_on(written);
    return cache::GridFile::open(path);
}

}  // namespace

Status measure_us(const Request& request, const fs::path& work, Table& table) {
    const fs::path directory = work / "us";
    std::error_code failed;
    fs::create_directories(directory, failed);
    if (failed) return fail(ErrorCode::io, "{}: {}", directory.string(), failed.message());
    const grid::GridSpec domain = us_grid();
    const fs::path file = request.data_directory() / "volumes/KLOT20220317_000842_V06";
    if (!fs::exists(file, failed)) return fail(ErrorCode::not_found, "{}: no file", file.string());
    const Newcomer newcomer = prepare(domain, file, "KLOT", position_of(*find_station("KDMX")));
    std::deque<cache::GridFile> files;
    MergeCase merged{"us", domain, {}, newcomer};
    for (const PlacedSite& placed : sites_of(domain, newcomer)) {
        auto distance =
            std::make_shared<const grid::SiteDistance>(domain, placed.window, placed.site);
        auto opened = partial_file(domain, placed, *distance, directory);
        if (!opened) return tl::unexpected(opened.error());
        files.push_back(std::move(*opened));
        merged.partials.push_back({files.back().view(), placed.site, std::move(distance)});
    }
    for (const int threads : request.threads)
        table.add(measure_merge(merged, threads, request.runs));
    return {};
}

}  // namespace stormcellar::bench
