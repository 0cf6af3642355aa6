#include "bench/feed_soak.h"

#include <cmath>
#include <set>
#include <string>

#include "stormcellar/cache/grid_name.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;

std::size_t files_below(const fs::path& directory, const std::string& ending) {
    std::size_t files = 0;
    std::error_code problem;
    for (const auto& entry : fs::recursive_directory_iterator(directory, problem)) {
        if (entry.is_regular_file(problem) && entry.path().native().ends_with(ending)) ++files;
    }
    return files;
}

Status check_site(const NationalFeed& feed, const NationalSite& site, int sent,
                  const catalog::CatalogReader& catalog, const DaemonProcess& daemon,
                  SoakCheck& check) {
    const auto rows = catalog.list(site.station.icao, {});
    if (!rows) return pass_on(rows);
    std::set<UtcTime> known;
    for (const catalog::CatalogEntry& row : *rows) {
        ++check.rows;
        std::error_code problem;
        const bool there = fs::exists(row.path, problem);
        if (there == (row.state == catalog::FileState::gone)) ++check.wrong_rows;
        const bool settled =
            row.state == catalog::FileState::complete || row.state == catalog::FileState::gone;
        if (settled && row.volume.start_time) known.insert(*row.volume.start_time);
    }
    for (int volume = 0; volume < sent; ++volume) {
        if (!known.contains(feed.start_of(site, volume))) ++check.missing_rows;
    }
    if (sent == 0) return {};
    const cache::GridName newest{std::string(site.station.icao), level2::Moment::ref,
                                 feed.start_of(site, sent - 1)};
    std::error_code problem;
    if (!fs::exists(daemon.cache() / cache::relative_path(newest), problem)) ++check.missing_grids;
    return {};
}

}  // namespace

double memory_slope_mib_h(std::span<const MemorySample> samples) {
    samples = samples.subspan(samples.size() / 10);
    if (samples.size() < 2) return std::nan("");
    double mean_s = 0, mean_mib = 0;
    for (const MemorySample& sample : samples) {
        mean_s += sample.wall_s / static_cast<double>(samples.size());
        mean_mib += sample.anonymous_mib / static_cast<double>(samples.size());
    }
    double products = 0, squares = 0;
    for (const MemorySample& sample : samples) {
        products += (sample.wall_s - mean_s) * (sample.anonymous_mib - mean_mib);
        squares += (sample.wall_s - mean_s) * (sample.wall_s - mean_s);
    }
    return 3600 * products / squares;
}

Result<SoakCheck> check_soak(const NationalFeed& feed, const std::vector<int>& volumes_sent,
                             const DaemonProcess& daemon) {
    SoakCheck check;
    auto catalog = catalog::CatalogReader::open(daemon.catalog());
    if (!catalog) return pass_on(catalog);
    check.files = files_below(daemon.drop(), "");
    check.grids = files_below(daemon.cache(), ".scg");
    for (std::size_t i = 0; i < feed.sites().size(); ++i) {
        auto done = check_site(feed, feed.sites()[i], volumes_sent[i], *catalog, daemon, check);
        if (!done) return pass_on(done);
    }
    return check;
}

}  // namespace stormcellar::bench
