#include "catalog/radar_set.h"

#include <algorithm>
#include <utility>

#include "base/file_system.h"

namespace stormcellar::catalog {
namespace {

// The path that the catalog has for a file name; the newest when several directories have it.
Result<std::filesystem::path> path_of(Catalog& catalog, const std::string& station,
                                      const std::string& name) {
    auto entries = catalog.list(station, Query{});
    if (!entries) return pass_on(entries);
    const auto found = std::find_if(entries->rbegin(), entries->rend(), [&](const auto& entry) {
        return entry.path.filename() == name;
    });
    if (found == entries->rend()) {
        return fail(ErrorCode::not_found, "{}: the catalog has no file {}", station, name);
    }
    return found->path;
}

}  // namespace

RadarSet::RadarSet(std::shared_ptr<Catalog> catalog, std::string station)
    : catalog_(std::move(catalog)), station_(std::move(station)) {}

Result<std::vector<RadarSet>> RadarSet::open_all(const std::filesystem::path& catalog_directory) {
    auto opened = Catalog::open_for_reading(catalog_directory);
    if (!opened) return pass_on(opened);
    const auto catalog = std::make_shared<Catalog>(std::move(*opened));
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
    auto sets = open_all(catalog_directory);
    if (!sets) return pass_on(sets);
    for (RadarSet& set : *sets) {
        if (set.station() == station) return std::move(set);
    }
    return fail(ErrorCode::not_found, "{}: the catalog knows no station {}",
                catalog_directory.native(), station);
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
    const auto path = path_of(*catalog_, station_, name);
    if (!path) return pass_on(path);
    return read_file(*path);
}

Result<level2::Decoded> RadarSet::read_radar(const std::string& name) const {
    const auto path = path_of(*catalog_, station_, name);
    if (!path) return pass_on(path);
    return level2::decode_file(*path);
}

}  // namespace stormcellar::catalog
