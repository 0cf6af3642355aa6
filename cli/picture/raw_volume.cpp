#include "cli/picture/raw_volume.h"

#include <map>
#include <utility>

#include <fmt/format.h>

#include "pipeline/drop/cataloged_volume.h"

namespace stormcellar::cli {
namespace {

Result<RawVolume> read_volume(const catalog::CatalogReader& catalog, const std::string& station,
                              UtcTime start,
                              const Result<std::optional<catalog::CatalogEntry>>& found) {
    if (!found) return pass_on(found);
    const std::string when = format_utc(start);
    if (!*found) {
        return fail(ErrorCode::not_found,
                    "{}: the catalog has no volume of {} that starts at {}; a ppi is drawn from "
                    "the raw file, so name that Level II file instead",
                    catalog.directory().native(), station, when);
    }
    const catalog::CatalogEntry& entry = **found;
    auto volume = pipeline::read_cataloged_volume(catalog, entry);
    if (volume)
        return RawVolume{entry.path.native(), entry.volume.start_time.value_or(start),
                         std::move(volume->bytes), volume->notes};
    if (volume.error().code != ErrorCode::not_found) return pass_on(volume);
    return fail(ErrorCode::not_found,
                "{}: the raw file of {} {} is gone, and a ppi cannot be drawn from the grid that "
                "was made of it",
                entry.path.native(), station, when);
}

}  // namespace

Result<std::vector<cache::StoreEntry>> grids_of_any_moment(const cache::StoreReader& store,
                                                           const std::string& domain,
                                                           std::optional<UtcTime> from,
                                                           std::optional<UtcTime> to) {
    std::map<UtcTime, cache::StoreEntry> by_time;
    for (const level2::Moment moment : level2::all_moments) {
        const auto entries = store.list(domain, moment, from, to);
        if (!entries) return pass_on(entries);
        for (const cache::StoreEntry& entry : *entries)
            by_time.emplace(entry.time, entry);
    }
    std::vector<cache::StoreEntry> all;
    for (auto& [time, entry] : by_time)
        all.push_back(std::move(entry));
    return all;
}

Result<RawVolume> raw_volume_of(const catalog::CatalogReader& catalog, const std::string& domain,
                                const cache::GridDescription& grid) {
    if (grid.sites.size() != 1) {
        return fail(ErrorCode::bad_argument,
                    "a ppi shows a sweep of one radar, and '{}' is a mosaic of {}; name one of its "
                    "stations, or the Level II file",
                    domain, grid.sites.size());
    }
    const std::string& station = grid.sites.front().icao;
    return read_volume(
        catalog, station, grid.time,
        pipeline::find_volume_of_grid(catalog, station, grid.time, grid.provenance.partial));
}

Result<RawVolume> raw_volume_at(const catalog::CatalogReader& catalog, const std::string& station,
                                UtcTime start, const std::filesystem::path& file) {
    return read_volume(catalog, station, start,
                       pipeline::find_cataloged_volume(
                           catalog, station, start,
                           [&](const catalog::CatalogEntry& entry) { return entry.path == file; }));
}

}  // namespace stormcellar::cli
