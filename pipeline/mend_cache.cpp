#include "pipeline/mend_cache.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "base/station_table.h"
#include "pipeline/file_facts.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using cache::GridFile;
using catalog::CatalogEntry;
using catalog::FileState;

constexpr std::chrono::minutes most_ahead{10};

struct Finding {
    Error error;
    bool opened = false;  // it is the contents that are wrong or cannot be read
};

std::optional<Finding> look_at(const fs::path& path, MendDepth depth) {
    const auto file = GridFile::open(path);
    if (!file) return Finding{file.error(), false};
    if (depth == MendDepth::header) return std::nullopt;
    if (const Status good = file->verify(); !good) return Finding{good.error(), true};
    return std::nullopt;
}

// A failed read of an open file is damage, too, but worth nothing to us only where the raw file is
// there; a failed open may mean that the system has no descriptors left.
bool is_damage(const Finding& found, bool has_raw) {
    const ErrorCode code = found.error.code;
    return code == ErrorCode::corrupt || code == ErrorCode::truncated ||
           (code == ErrorCode::io && found.opened && has_raw);
}

// Whether the catalog knows the file as it stands there now. Its modification time; none if not.
std::optional<std::int64_t> settled_as_it_is(catalog::Catalog& catalog, const fs::path& path) {
    const auto stamp = stamp_of(path);
    if (!stamp || !stamp->regular) return std::nullopt;
    const auto settled = catalog.is_settled(path, stamp->size_bytes, stamp->modified_ns);
    if (!settled || !*settled) return std::nullopt;
    return stamp->modified_ns;
}

bool may_have_a_grid(const CatalogEntry& entry) {
    return (entry.state == FileState::complete || entry.state == FileState::partial) &&
           entry.volume.start_time && entry.volume.radial_count > 0;
}

// The file whose grid is the one to stand, as pipeline/ingest.h has it.
std::optional<fs::path> best_of(catalog::Catalog& catalog,
                                std::span<const CatalogEntry> of_one_volume) {
    using Rank = std::tuple<bool, std::int64_t>;
    std::optional<std::pair<Rank, fs::path>> best;
    for (const CatalogEntry& entry : of_one_volume) {
        if (!may_have_a_grid(entry)) continue;
        const auto modified_ns = settled_as_it_is(catalog, entry.path);
        if (!modified_ns) continue;
        const Rank rank{entry.volume.complete, *modified_ns};
        if (!best || rank > best->first) best = {rank, entry.path};
    }
    if (!best) return std::nullopt;
    return best->second;
}

}  // namespace

CacheMender::CacheMender(catalog::Catalog& catalog, const cache::Store& store, Ingestor& ingestor,
                         level2::Moment moment)
    : catalog_(catalog), store_(store), ingestor_(ingestor), moment_(moment) {}

Result<std::optional<fs::path>> CacheMender::raw_of(const std::string& station, UtcTime time) {
    if (!is_icao(station)) return std::optional<fs::path>{};
    const auto entries = catalog_.list(station, {time, time, false});
    if (!entries && entries.error().code == ErrorCode::not_found) return std::optional<fs::path>{};
    if (!entries) return pass_on(entries);
    return best_of(catalog_, *entries);
}

Result<MendedGrid> CacheMender::mend(const cache::StoreEntry& entry, MendDepth depth) {
    const auto found = look_at(entry.path, depth);
    // Evicted or replaced meanwhile: nothing is wrong with that.
    if (!found || found->error.code == ErrorCode::not_found) return MendedGrid{};
    auto raw = entry.moment == moment_ ? raw_of(entry.domain, entry.time)
                                       : Result<std::optional<fs::path>>{std::nullopt};
    if (!raw) return pass_on(raw);
    MendedGrid mended{GridCondition::left_alone, found->error.message, {}};
    if (!is_damage(*found, raw->has_value())) return mended;

    const Status removed = store_.remove(entry);
    if (!removed && removed.error().code != ErrorCode::not_found) return pass_on(removed);
    mended.condition = GridCondition::dropped;
    if (!*raw) return mended;
    const auto outcome = ingestor_.ingest_again(**raw);
    if (!outcome) return pass_on(outcome);
    const auto& made = outcome->grids;
    if (std::find(made.begin(), made.end(), entry.path) == made.end()) return mended;
    mended.condition = GridCondition::made_again;
    mended.raw = std::move(**raw);
    return mended;
}

Result<std::vector<MissingGrid>> CacheMender::missing_of(const std::string& station,
                                                         std::chrono::milliseconds newest) {
    std::vector<MissingGrid> missing;
    auto entries = catalog_.list(station, {{}, now_utc() + most_ahead, false});
    if (!entries) return pass_on(entries);
    if (entries->empty()) return missing;
    const auto grids = store_.list(station, moment_, std::nullopt, std::nullopt);
    if (!grids) return pass_on(grids);
    std::set<UtcTime> standing;
    for (const auto& grid : *grids)
        standing.insert(grid.time);
    UtcTime from = *entries->back().volume.start_time - newest;
    if (!standing.empty()) from = std::max(from, *standing.begin());

    const std::span<const CatalogEntry> all = *entries;
    for (std::size_t first = 0; first < all.size();) {
        const auto time = all[first].volume.start_time;
        std::size_t end = first;
        while (end < all.size() && all[end].volume.start_time == time)
            ++end;
        if (*time >= from && !standing.contains(*time)) {
            const auto raw = best_of(catalog_, all.subspan(first, end - first));
            if (raw) missing.push_back({station, *time, *raw});
        }
        first = end;
    }
    return missing;
}

Result<std::vector<MissingGrid>> CacheMender::missing(std::chrono::milliseconds newest) {
    std::vector<MissingGrid> all;
    const auto stations = catalog_.station_names();
    if (!stations) return pass_on(stations);
    for (const std::string& station : *stations) {
        if (station.empty()) continue;
        const auto here = missing_of(station, newest);
        if (!here) return pass_on(here);
        all.insert(all.end(), here->begin(), here->end());
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const MissingGrid& a, const MissingGrid& b) { return a.time > b.time; });
    return all;
}

Result<IngestOutcome> CacheMender::make(const MissingGrid& grid) {
    return ingestor_.ingest_again(grid.raw);
}

}  // namespace stormcellar::pipeline
