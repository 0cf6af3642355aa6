#include "bench/us_mosaic.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/merge_case.h"
#include "bench/us_storms.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t us_sites = 160;
constexpr int stripes = 8;

struct PlacedSite {
    grid::SitePosition site;
    grid::GridWindow window;
};

// These sites first, then those within the domain.
std::vector<PlacedSite> sites_of(const grid::GridSpec& domain, std::vector<PlacedSite> sites) {
    const grid::GridProjection projection(domain);
    for (const Station& station : all_stations()) {
        if (sites.size() == us_sites) break;
        const grid::SitePosition site = position_of(station);
        const auto window = grid::site_window(domain, site);
        const auto column = projection.to_column({site.latitude_deg, site.longitude_deg});
        const bool inside =
            column.x > 0 && column.x < domain.nx && column.y > 0 && column.y < domain.ny;
        const bool is_known = std::ranges::any_of(
            sites, [&](const PlacedSite& known) { return known.site.icao == site.icao; });
        if (!window || !inside || is_known) continue;
        sites.push_back({site, *window});
    }
    return sites;
}

// The partials of all sites as files, which are open while they are in use.
class PartialFiles {
  public:
    PartialFiles(const grid::GridSpec& domain, const fs::path& directory,
                 std::vector<PlacedSite> sites)
        : domain_(domain), directory_(directory), sites_(std::move(sites)) {
        for (const PlacedSite& placed : sites_) {
            distances_.push_back(
                std::make_shared<const grid::SiteDistance>(domain, placed.window, placed.site));
        }
    }

    // Makes the missing files. Returns the mean share of bricks with values.
    Result<double> make() {
        double stored = 0;
        for (std::size_t at = 0; at < sites_.size(); ++at) {
            auto opened = cache::GridFile::open(path_of(at));
            if (!opened) {
                if (Status written = write(at); !written) return pass_on(written);
                opened = cache::GridFile::open(path_of(at));
            }
            if (!opened) return pass_on(opened);
            stored += stored_part(opened->view());
        }
        return stored / static_cast<double>(sites_.size());
    }

    Result<std::vector<grid::Partial>> open_in(const grid::GridWindow& window) {
        open_.clear();
        std::vector<grid::Partial> partials;
        for (std::size_t at = 0; at < sites_.size(); ++at) {
            const PlacedSite& placed = sites_[at];
            const bool touches =
                placed.window.first_x < window.end_x() && window.first_x < placed.window.end_x() &&
                placed.window.first_y < window.end_y() && window.first_y < placed.window.end_y();
            if (!touches) continue;
            auto opened = cache::GridFile::open(path_of(at));
            if (!opened) return pass_on(opened);
            open_.push_back(std::move(*opened));
            partials.push_back({open_.back().view(), placed.site, distances_[at]});
        }
        return partials;
    }

  private:
    [[nodiscard]] fs::path path_of(std::size_t at) const {
        return directory_ / fmt::format("{}.grid", sites_[at].site.icao);
    }
    [[nodiscard]] Status write(std::size_t at) const {
        const grid::BrickGrid made =
            us_storms(domain_, sites_[at].window, *distances_[at], sites_[at].site);
        cache::GridDescription description;
        description.spec = made.spec();
        description.sites = {sites_[at].site};
        const auto written =
            cache::write_grid_file(real_file_system(), path_of(at), description, made.view());
        if (!written) return pass_on(written);
        return {};
    }

    const grid::GridSpec& domain_;
    fs::path directory_;
    std::vector<PlacedSite> sites_;
    std::vector<std::shared_ptr<const grid::SiteDistance>> distances_;
    std::deque<cache::GridFile> open_;
};

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
    std::vector<PlacedSite> sites = sites_of(domain, {{newcomer.site, newcomer.window}});
    const auto count = static_cast<int>(sites.size());
    PartialFiles files(domain, directory, std::move(sites));
    const auto stored = files.make();
    if (!stored) return pass_on(stored);
    MergeCase merged{"us", domain, count,
                     [&](const grid::GridWindow& window) { return files.open_in(window); },
                     newcomer};
    merged.stripes = stripes;
    merged.others_stored = *stored;
    for (const int threads : request.threads) {
        auto row = measure_merge(merged, threads, request.runs);
        if (!row) return pass_on(row);
        table.add(std::move(*row));
    }
    return {};
}

Result<grid::BrickGrid> us_mosaic() {
    const grid::GridSpec domain = us_grid();
    const std::vector<PlacedSite> sites = sites_of(domain, {});
    std::deque<grid::BrickGrid> grids;
    std::vector<grid::Partial> partials;
    for (const PlacedSite& placed : sites) {
        const auto distance =
            std::make_shared<const grid::SiteDistance>(domain, placed.window, placed.site);
        grids.push_back(us_storms(domain, placed.window, *distance, placed.site));
        partials.push_back({grids.back().view(), placed.site, distance});
    }
    auto merged = grid::merge(domain, partials, {.threads = 2});
    if (!merged) return pass_on(merged);
    return std::move(merged->cells);
}

}  // namespace stormcellar::bench
