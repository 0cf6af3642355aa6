#include "stormcellar/catalog/radar_set.h"

#include <algorithm>
#include <utility>

#include "stormcellar/catalog/read_cataloged.h"

namespace stormcellar::catalog {
namespace {

// Returns the newest entry of a file with this name, in any directory.
Result<CatalogEntry> entry_of(const CatalogReader& catalog, const std::string& station,
                              const std::string& name) {
    auto entries = catalog.list(station, Query{});
    if (!entries) return pass_on(entries);
    const auto found = std::find_if(entries->rbegin(), entries->rend(), [&](const auto& entry) {
        return entry.path.filename() == name;
    });
    if (found == entries->rend()) {
        return fail(ErrorCode::not_found, "{}: the catalog has no file {}", station, name);
    }
    return *found;
}

}  // namespace

RadarSet::RadarSet(std::shared_ptr<const CatalogReader> catalog, std::string station)
    : catalog_(std::move(catalog)), station_(std::move(station)) {}

Result<std::vector<RadarSet>> RadarSet::open_all(const std::filesystem::path& catalog_directory) {
    auto opened = CatalogReader::open(catalog_directory);
    if (!opened) return pass_on(opened);
    const auto catalog = std::make_shared<const CatalogReader>(std::move(*opened));
    const auto stations = catalog->stations();
    if (!stations) return pass_on(stations);
    std::vector<RadarSet> sets;
    for (const StationSummary& summary : *stations) {
        if (!summary.station.empty()) sets.push_back(RadarSet(catalog, summary.station));
    }
    return sets;
}

Result<RadarSet> RadarSet::open(const std::filesystem::path& catalog_directory,
                                const std::string& station) {
    auto opened = CatalogReader::open(catalog_directory);
    if (!opened) return pass_on(opened);
    if (station.empty()) return fail(ErrorCode::bad_argument, "the station has no name");
    // Only the station's own database must be sound.
    if (const auto newest = opened->latest(station); !newest) return pass_on(newest);
    return RadarSet(std::make_shared<const CatalogReader>(std::move(*opened)), station);
}

Result<std::vector<std::string>> RadarSet::build_data_list(UtcTime from, UtcTime to) const {
    const auto entries = catalog_->list(station_, Query{from, to, false});
    if (!entries) return pass_on(entries);
    std::vector<std::string> names;
    for (const CatalogEntry& entry : *entries) {
        const std::string name = entry.path.filename();
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    return names;
}

Result<std::string> RadarSet::oldest_file_name() const {
    const auto entry = catalog_->oldest(station_);
    if (!entry) return pass_on(entry);
    if (!entry->has_value()) {
        return fail(ErrorCode::not_found, "{}: the catalog has no volume", station_);
    }
    return (*entry)->path.filename().string();
}

Result<std::vector<std::byte>> RadarSet::radar_file(const std::string& name) const {
    const auto entry = entry_of(*catalog_, station_, name);
    if (!entry) return pass_on(entry);
    auto read = read_cataloged(*catalog_, *entry);
    if (!read) return pass_on(read);
    return std::move(read->bytes);
}

Result<level2::Decoded> RadarSet::read_radar(const std::string& name) const {
    const auto bytes = radar_file(name);
    if (!bytes) return pass_on(bytes);
    level2::DecodeOptions options;
    options.fallback_station = station_;
    auto decoded = level2::decode(*bytes, options);
    if (!decoded) return fail(decoded.error().code, "{}: {}", name, decoded.error().message);
    return decoded;
}

}  // namespace stormcellar::catalog
