#include "cli/picture/raw_volume.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "pipeline/drop/cataloged_volume.h"

namespace stormcellar::cli {
namespace {

// Of several files of one volume the one that made the grid comes first, then those that are there.
const catalog::CatalogEntry* best_of(
    const std::vector<catalog::CatalogEntry>& entries,
    const std::function<bool(const catalog::CatalogEntry&)>& made_it) {
    const auto rank = [&](const catalog::CatalogEntry& entry) {
        return std::pair{entry.state == catalog::FileState::gone, !made_it(entry)};
    };
    const auto best = std::ranges::min_element(entries, {}, rank);
    return best == entries.end() ? nullptr : &*best;
}

Result<RawVolume> read_volume(const catalog::CatalogReader& catalog, const std::string& station,
                              UtcTime start,
                              const std::function<bool(const catalog::CatalogEntry&)>& made_it) {
    const std::string when = format_utc(start);
    const auto entries = catalog.list(station, {start, start});
    if (!entries) return pass_on(entries);
    const catalog::CatalogEntry* const entry = best_of(*entries, made_it);
    if (entry == nullptr) {
        return fail(ErrorCode::not_found,
                    "{}: the catalog has no volume of {} that starts at {}; a ppi is drawn from "
                    "the raw file, which may be named itself",
                    catalog.directory().native(), station, when);
    }
    auto volume = pipeline::read_cataloged_volume(catalog, *entry);
    if (volume) return RawVolume{entry->path.native(), std::move(volume->bytes), volume->notes};
    if (volume.error().code != ErrorCode::not_found) return pass_on(volume);
    return fail(ErrorCode::not_found,
                "{}: the raw file of {} {} is gone, and a ppi cannot be drawn from the grid that "
                "was made of it",
                entry->path.native(), station, when);
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
    return read_volume(
        catalog, grid.sites.front().icao, grid.time, [&](const catalog::CatalogEntry& entry) {
            const auto& files = grid.provenance.source_files;
            return std::ranges::find(files, entry.path.filename().string()) != files.end();
        });
}

Result<RawVolume> raw_volume_at(const catalog::CatalogReader& catalog, const std::string& station,
                                UtcTime start, const std::filesystem::path& file) {
    return read_volume(catalog, station, start,
                       [&](const catalog::CatalogEntry& entry) { return entry.path == file; });
}

}  // namespace stormcellar::cli
