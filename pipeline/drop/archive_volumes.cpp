#include "pipeline/drop/archive_volumes.h"

#include <algorithm>
#include <map>
#include <utility>

#include "stormcellar/base/member_name.h"

namespace stormcellar::pipeline {
namespace {

using catalog::CatalogEntry;

// Returns true if `a` is the better of two files that have the same volume.
bool is_better(const CatalogEntry& a, const CatalogEntry& b) {
    const auto rank = [](const CatalogEntry& entry) {
        return std::tuple(entry.state != catalog::FileState::gone, entry.volume.complete,
                          entry.generation);
    };
    return rank(a) > rank(b);
}

bool is_one_of(const std::set<std::filesystem::path>& files, const std::filesystem::path& path) {
    if (files.empty() || files.contains(path) || files.contains(path.parent_path())) return true;
    const auto members = member_names_in(path);
    return std::ranges::any_of(
        members, [&](const MemberName& name) { return files.contains(name.archive); });
}

std::vector<ArchiveVolume> each_once(const std::string& station,
                                     const std::vector<CatalogEntry>& entries) {
    std::map<UtcTime, const CatalogEntry*> best;
    for (const CatalogEntry& entry : entries) {
        if (!entry.volume.start_time) continue;
        const CatalogEntry*& known = best[*entry.volume.start_time];
        if (known == nullptr || is_better(entry, *known)) known = &entry;
    }
    std::vector<ArchiveVolume> volumes;
    for (const auto& [start, entry] : best) {
        const UtcTime end = std::max(entry->volume.end_time.value_or(start), start);
        volumes.push_back({station, entry->path, start, end, entry->size_bytes,
                           entry->state == catalog::FileState::gone});
    }
    return volumes;
}

// Keeps only the volumes of one station that belong to the range, ordered by start.
void keep_taken(const ArchiveRange& range, std::vector<ArchiveVolume>& volumes) {
    const auto first = std::find_if(volumes.begin(), volumes.end(), [&](const ArchiveVolume& one) {
        return one.end >= range.from;
    });
    const auto after = std::find_if(first, volumes.end(),
                                    [&](const ArchiveVolume& one) { return one.start > range.to; });
    const bool one_before = range.with_neighbours && first != volumes.begin();
    const bool one_after = range.with_neighbours && after != volumes.end();
    volumes.erase(one_after ? after + 1 : after, volumes.end());
    volumes.erase(volumes.begin(), one_before ? first - 1 : first);
}

}  // namespace

Result<std::vector<ArchiveVolume>> archive_volumes(const catalog::CatalogReader& catalog,
                                                   const std::vector<std::string>& stations,
                                                   const ArchiveRange& range) {
    std::vector<ArchiveVolume> all;
    const auto margin = range.with_neighbours ? farthest_neighbour : longest_volume;
    catalog::Query query;
    query.from = range.from - margin;
    query.to = range.with_neighbours ? range.to + farthest_neighbour : range.to;
    for (const std::string& station : stations) {
        auto entries = catalog.list(station, query);
        if (!entries) {
            const bool is_alone = stations.size() == 1;
            if (is_alone && entries.error().code != ErrorCode::not_found) return pass_on(entries);
            continue;
        }
        std::erase_if(*entries, [&](const CatalogEntry& entry) {
            return !is_one_of(range.only, entry.path);
        });
        auto volumes = each_once(station, *entries);
        keep_taken(range, volumes);
        std::move(volumes.begin(), volumes.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace stormcellar::pipeline
