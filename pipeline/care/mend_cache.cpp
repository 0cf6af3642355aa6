#include "pipeline/care/mend_cache.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/ranges.h>

#include "pipeline/drop/file_facts.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/catalog/read_cataloged.h"
#include "stormcellar/grid/grid_window.h"

namespace stormcellar::pipeline {
namespace {

namespace fs = std::filesystem;
using cache::GridFile;
using catalog::CatalogEntry;
using catalog::FileState;

constexpr std::chrono::minutes most_ahead{10};

struct Finding {
    Error error;
    bool opened = false;  // the file opened, so the error is in its contents
};

std::optional<Finding> look_at(const fs::path& path, MendDepth depth) {
    const auto file = GridFile::open(path);
    if (!file) return Finding{file.error(), false};
    if (depth == MendDepth::header) return std::nullopt;
    if (const Status good = file->verify(); !good) return Finding{good.error(), true};
    return std::nullopt;
}

// Returns true if the grid is damaged. If reading an open file failed, the grid counts as damaged
// only if it can be made again from a source. If opening failed, the grid does not count as
// damaged, because the system may have no descriptors left.
bool is_damage(const Finding& found, bool has_source) {
    const ErrorCode code = found.error.code;
    return code == ErrorCode::corrupt || code == ErrorCode::truncated ||
           (code == ErrorCode::io && found.opened && has_source);
}

bool holds(const std::vector<fs::path>& paths, const fs::path& path) {
    return std::find(paths.begin(), paths.end(), path) != paths.end();
}

std::string joined(const std::vector<std::string>& texts) {
    return fmt::format("{}", fmt::join(texts, ", "));
}

bool is_settled_as_it_is(const catalog::CatalogReader& catalog, const fs::path& path) {
    const auto stamp = stamp_of(path);
    if (!stamp || !stamp->regular) return false;
    const auto settled = catalog.is_settled(path, stamp->size_bytes, stamp->modified_ns);
    return settled && *settled;
}

bool may_have_a_grid(const CatalogEntry& entry) {
    return (entry.state == FileState::complete || entry.state == FileState::partial) &&
           entry.volume.start_time && entry.volume.radial_count > 0;
}

// Returns the file from which the grid of a volume must be made. Prefers a complete file, then the
// file with the later end, then the file with the larger hash. The age of the files does not
// matter.
std::optional<fs::path> best_of(const catalog::CatalogReader& catalog,
                                std::span<const CatalogEntry> of_one_volume) {
    using Rank = std::tuple<bool, std::optional<UtcTime>, std::uint64_t>;
    std::optional<std::pair<Rank, fs::path>> best;
    for (const CatalogEntry& entry : of_one_volume) {
        if (!may_have_a_grid(entry)) continue;
        if (!is_settled_as_it_is(catalog, entry.path)) continue;
        const Rank rank{entry.volume.complete, entry.volume.end_time, entry.content_hash};
        if (!best || rank > best->first) best = {rank, entry.path};
    }
    if (!best) return std::nullopt;
    return best->second;
}

}  // namespace

CacheMender::CacheMender(const catalog::CatalogReader& catalog, cache::StoreWriter& store,
                         Ingestor& ingestor, std::vector<level2::Moment> moments)
    : catalog_(catalog), store_(store), ingestor_(ingestor), moments_(std::move(moments)) {}

Result<std::optional<fs::path>> CacheMender::raw_of(const std::string& station, UtcTime time) {
    if (!is_icao(station)) return std::optional<fs::path>{};
    const auto entries = catalog_.list(station, {time, time, false});
    if (!entries && entries.error().code == ErrorCode::not_found) return std::optional<fs::path>{};
    if (!entries) return pass_on(entries);
    return best_of(catalog_, *entries);
}

std::string CacheMender::why_not_again(const std::string& station, UtcTime time) {
    const auto entries = catalog_.list(station, {time, time, false});
    if (!entries || entries->empty())
        return "the catalog here has no raw file of it; another machine may have made it";
    const auto is_there = [](const CatalogEntry& entry) {
        return entry.state != FileState::gone && !member_names_in(entry.path).empty();
    };
    if (std::ranges::any_of(*entries, is_there))
        return "it was made of a member of an archive, and such grids are not made again";
    return "its raw file is gone, has changed or still grows";
}

Result<MendedGrid> CacheMender::mend(const cache::StoreEntry& entry, MendDepth depth) {
    const auto found = look_at(entry.path, depth);
    // If there is no error, the grid is sound. If the grid is gone, it was evicted in the meantime.
    if (!found || found->error.code == ErrorCode::not_found) return MendedGrid{};
    const MosaicMaker& mosaics = ingestor_.mosaics();
    if (mosaics.find(entry.domain, entry.moment) != nullptr) {
        if (is_damage(*found, true)) return mend_frame(entry, found->error);
        return MendedGrid{GridCondition::left_alone, found->error.message, {}, {}};
    }
    const std::string group{cache::group_of(entry.domain)};
    const bool part = cache::is_part(entry.domain);
    const std::string station = part ? entry.domain.substr(group.size() + 1) : entry.domain;
    const Domain* domain = part ? mosaics.find(group, entry.moment) : nullptr;
    const bool wanted = part ? domain != nullptr && domain->takes(station)
                             : std::ranges::find(moments_, entry.moment) != moments_.end();
    if (!is_damage(*found, wanted)) {
        return MendedGrid{GridCondition::left_alone, found->error.message, {}, {}};
    }
    if (wanted && is_icao(station)) return mend_from_raw(entry, station, found->error);
    if (found->error.code == ErrorCode::io) {
        return MendedGrid{GridCondition::left_alone, found->error.message, {}, {}};
    }
    const Status removed = store_.remove(entry);
    if (!removed && removed.error().code != ErrorCode::not_found) return pass_on(removed);
    return MendedGrid{GridCondition::dropped,
                      found->error.message,
                      {},
                      fmt::format("the configuration no longer has {} of {}",
                                  level2::moment_name(entry.moment), entry.domain)};
}

// Makes the grids from a raw file. Compares the contents, because a file with the same size and
// time may have replaced the cataloged file.
Result<IngestOutcome> CacheMender::make_from(const fs::path& raw, const std::string& station) {
    return ingestor_.ingest_again(
        raw,
        [&](const fs::path& path, std::uint64_t size_bytes, std::uint64_t content_hash) -> Status {
            const auto row = catalog_.find_file(station, path);
            if (!row) return pass_on(row);
            if (!*row || !catalog::has_final_hash(**row)) return {};
            return catalog::check_cataloged(**row, size_bytes, content_hash);
        });
}

Result<MendedGrid> CacheMender::mend_from_raw(const cache::StoreEntry& entry,
                                              const std::string& station, const Error& damage) {
    const auto raw = raw_of(station, entry.time);
    if (!raw) return pass_on(raw);
    if (!*raw && damage.code == ErrorCode::io) {
        return MendedGrid{GridCondition::left_alone, damage.message, {}, {}};
    }
    const Status removed = store_.remove(entry);
    if (!removed && removed.error().code != ErrorCode::not_found) return pass_on(removed);
    MendedGrid mended{GridCondition::dropped, damage.message, {}, {}};
    if (!*raw) {
        mended.why_not = why_not_again(station, entry.time);
        return mended;
    }
    const auto outcome = make_from(**raw, station);
    if (!outcome && outcome.error().cause() == Cause::data) {
        mended.why_not = outcome.error().message;
        return mended;
    }
    if (!outcome) return pass_on(outcome);
    if (!holds(outcome->grids, entry.path) && !holds(outcome->partials, entry.path)) {
        mended.why_not = fmt::format(
            "{} no longer gives this grid{}", (*raw)->native(),
            outcome->reason.empty() ? std::string{} : fmt::format(" ({})", outcome->reason));
        return mended;
    }
    mended.condition = GridCondition::made_again;
    mended.from = (*raw)->native();
    mended.why_not.clear();
    return mended;
}

// Makes the frame again. The new frame replaces the damaged one at once, and continues its count of
// revisions.
Result<MendedGrid> CacheMender::mend_frame(const cache::StoreEntry& entry, const Error& damage) {
    MendedGrid mended{GridCondition::made_again, damage.message, {}, {}};
    std::vector<std::string> problems;
    const auto made =
        ingestor_.mosaics().make_again({entry.domain, entry.moment, entry.time}, 1, problems);
    if (made && !made->path.empty()) {
        mended.from = fmt::format("the partials of {}", joined(made->stations));
        if (!problems.empty()) mended.from += fmt::format(" (left out: {})", joined(problems));
        return mended;
    }
    // Another try would fail, too, if the domain has no such frame, no partial is near it, or its
    // partials contradict each other.
    const bool never_made = !made && (made.error().code == ErrorCode::not_found ||
                                      made.error().code == ErrorCode::bad_argument);
    if (!made && !never_made) return pass_on(made);
    const Status removed = store_.remove(entry);
    if (!removed && removed.error().code != ErrorCode::not_found) return pass_on(removed);
    mended.condition = GridCondition::dropped;
    mended.why_not = made ? "it is older than all that the cache keeps" : made.error().message;
    if (!problems.empty()) mended.why_not += fmt::format(" (left out: {})", joined(problems));
    return mended;
}

// Returns the series of grids that the ingestor makes of this station's volumes. Includes partials
// only if it is known that the station reaches the domain.
std::vector<CacheMender::Series> CacheMender::series_of(const std::string& station) const {
    std::vector<Series> all;
    for (const level2::Moment moment : moments_)
        all.push_back({station, moment});
    const auto place = find_station(station);
    if (!place) return all;
    const grid::SitePosition site{station, place->latitude_deg, place->longitude_deg,
                                  place->antenna_altitude_m};
    for (const Domain& domain : ingestor_.mosaics().domains()) {
        if (!domain.takes(station) || !grid::site_window(domain.spec, site)) continue;
        for (const level2::Moment moment : domain.moments)
            all.push_back({domain.name + "." + station, moment});
    }
    return all;
}

Result<std::vector<CacheMender::Standing>> CacheMender::standing_of(const std::string& station,
                                                                    UtcTime oldest) {
    std::vector<Standing> all;
    for (Series& series : series_of(station)) {
        const auto grids = store_.list(series.domain, series.moment, std::nullopt, std::nullopt);
        if (!grids) return pass_on(grids);
        Standing standing{std::move(series), {}, oldest};
        for (const auto& grid : *grids)
            standing.times.insert(grid.time);
        if (!standing.times.empty()) {
            standing.from = std::max(standing.from, *standing.times.begin());
        }
        all.push_back(std::move(standing));
    }
    return all;
}

Result<std::vector<MissingGrid>> CacheMender::missing_of(const std::string& station,
                                                         std::chrono::milliseconds newest) {
    std::vector<MissingGrid> missing;
    auto entries = catalog_.list(station, {{}, now_utc() + most_ahead, false});
    // Skip a station whose database cannot be read, because the catalog reports it (troubles()).
    if (!entries || entries->empty()) return missing;
    const auto standing = standing_of(station, *entries->back().volume.start_time - newest);
    if (!standing) return pass_on(standing);

    const std::span<const CatalogEntry> all = *entries;
    for (std::size_t first = 0; first < all.size();) {
        const auto time = all[first].volume.start_time;
        std::size_t end = first;
        while (end < all.size() && all[end].volume.start_time == time)
            ++end;
        MissingGrid grid{station, *time, {}, {}};
        for (const Standing& one : *standing) {
            const cache::GridName name{one.series.domain, one.series.moment, *time};
            const bool lacks = *time >= one.from && !one.times.contains(*time);
            if (lacks && !failed_.contains(name)) grid.names.push_back(name);
        }
        const auto raw =
            grid.names.empty() ? std::nullopt : best_of(catalog_, all.subspan(first, end - first));
        if (raw) {
            grid.raw = *raw;
            missing.push_back(std::move(grid));
        }
        first = end;
    }
    return missing;
}

Result<std::vector<MissingGrid>> CacheMender::missing(std::chrono::milliseconds newest,
                                                      const std::function<void()>& step) {
    std::vector<MissingGrid> all;
    const auto stations = catalog_.station_names();
    if (!stations) return pass_on(stations);
    for (const std::string& station : *stations) {
        if (station.empty()) continue;
        const auto here = missing_of(station, newest);
        if (step) step();
        if (!here && is_shortage(here.error().code)) return pass_on(here);
        if (here) all.insert(all.end(), here->begin(), here->end());
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const MissingGrid& a, const MissingGrid& b) { return a.time > b.time; });
    return all;
}

Result<IngestOutcome> CacheMender::make(const MissingGrid& grid) {
    auto outcome = make_from(grid.raw, grid.station);
    if (!outcome) {
        if (outcome.error().cause() == Cause::data)
            failed_.insert(grid.names.begin(), grid.names.end());
        return outcome;
    }
    for (const cache::GridName& name : grid.names) {
        const auto path = store_.path_of(name.domain, name.moment, name.time);
        const bool made = path && (holds(outcome->grids, *path) || holds(outcome->partials, *path));
        if (!made) failed_.insert(name);
    }
    return outcome;
}

Result<std::vector<cache::GridName>> CacheMender::missing_frames(std::chrono::milliseconds newest) {
    auto missing = pipeline::missing_frames(store_, ingestor_.mosaics().domains(), newest);
    if (!missing) return missing;
    std::erase_if(*missing, [&](const cache::GridName& name) { return failed_.contains(name); });
    return missing;
}

Result<std::optional<std::string>> CacheMender::make(const cache::GridName& frame) {
    std::vector<std::string> problems;
    const auto made = ingestor_.mosaics().make_again(frame, 1, problems);
    if (!made && made.error().code != ErrorCode::not_found) return pass_on(made);
    if (!made || made->path.empty()) {
        failed_.insert(frame);
        return std::optional<std::string>{};
    }
    return fmt::format("the partials of {}", joined(made->stations));
}

}  // namespace stormcellar::pipeline
