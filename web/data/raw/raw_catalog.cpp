// Serves the raw files of a catalog.
#include <algorithm>
#include <map>
#include <tuple>
#include <unordered_map>

#include <sys/stat.h>

#include "base/steady_time.h"
#include "pipeline/drop/cataloged_volume.h"
#include "stormcellar/base/member_name.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/catalog/read_cataloged.h"
#include "web/data/raw/raw_files.h"
#include "web/data/raw/raw_name.h"
#include "web/data/raw/raw_opener.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;
using catalog::CatalogEntry;
using catalog::CatalogReader;
using catalog::FileState;
using std::chrono::steady_clock;

constexpr std::chrono::seconds kept_open_for{2}, floor_holds_for{30};
// The time in the name of a dropped file may differ from the volume's start by this much. The two
// differ by seconds, and some names have no seconds.
constexpr std::chrono::minutes own_name_differs{2};
// Number of rows that are read in addition to the wanted ones, because a file may have come several
// times.
constexpr std::size_t more_rows = 200;
constexpr std::size_t most_rows_of_a_name = 500;

// Leaves out members of archives. They are not served, and thousands may be between two served
// files.
const catalog::Stretch of_served{.with_members = false};

// Returns true if `a` is the better file of the same name.
bool is_better_raw(const CatalogEntry& a, const CatalogEntry& b) {
    const auto rank = [](const CatalogEntry& entry) {
        return std::tuple(entry.state != FileState::gone, entry.state != FileState::seen,
                          entry.volume.complete, entry.generation, entry.registered_time);
    };
    return rank(a) > rank(b);
}

RawVolume volume_of(const CatalogEntry& entry) {
    RawVolume volume;
    volume.station = entry.station;
    volume.name = name_of_entry(entry);
    volume.start = *entry.volume.start_time;
    volume.grows = !catalog::has_final_hash(entry);
    volume.is_complete = entry.volume.complete && !volume.grows;
    volume.number = entry.volume.volume_number;
    return volume;
}

class CatalogRawFiles final : public RawFiles {
  public:
    explicit CatalogRawFiles(RawFilesOptions options)
        : options_(std::move(options)),
          opener_(options_.scratch, options_.most_joined, options_.most_joined_bytes),
          reader_(options_.reader) {}

    Result<std::vector<RawStation>> stations() override;
    Result<std::vector<RawVolume>> list(std::string_view station, const RawRange& range) override;
    OpenedOrMissing open(std::string_view station, std::string_view name) override;
    std::optional<OpenedVolume> open_kept(std::string_view station, std::string_view name) override;

  private:
    struct KeptOpen {
        OpenedVolume volume;
        struct stat facts {};
        steady_clock::time_point opened{};
    };
    struct Floor {
        std::optional<UtcTime> start;
        steady_clock::time_point found{};
    };
    // Returns the reader, or null while there is no catalog.
    std::shared_ptr<const CatalogReader> reader();
    Result<std::vector<CatalogEntry>> rows_of(const CatalogReader& catalog,
                                              std::string_view station, const RawRange& range);
    Result<std::optional<UtcTime>> floor_of(const CatalogReader& catalog, std::string_view station);
    Result<std::optional<CatalogEntry>> find(const CatalogReader& catalog, std::string_view station,
                                             std::string_view name);
    Result<std::optional<CatalogEntry>> find_by_own_name(const CatalogReader& catalog,
                                                         std::string_view station,
                                                         std::string_view name);
    void keep_open(const std::string& key, const OpenedVolume& volume, const Descriptor& file);

    const RawFilesOptions options_;
    RawOpener opener_;
    Mutex mutex_;
    std::shared_ptr<const CatalogReader> reader_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<std::string, Floor, std::less<>> floors_ STORMCELLAR_GUARDED_BY(mutex_);
    std::unordered_map<std::string, KeptOpen> open_ STORMCELLAR_GUARDED_BY(mutex_);
};

std::shared_ptr<const CatalogReader> CatalogRawFiles::reader() {
    const MutexLock lock(mutex_);
    if (!reader_) {
        auto opened = CatalogReader::open(options_.catalog, options_.most_databases);
        if (opened) reader_ = std::make_shared<const CatalogReader>(std::move(*opened));
    }
    return reader_;
}

Result<std::vector<RawStation>> CatalogRawFiles::stations() {
    std::vector<RawStation> stations;
    const auto catalog = reader();
    if (!catalog) return stations;
    const auto names = catalog->station_names();
    if (!names) return pass_on(names);
    for (const std::string& icao : *names) {
        if (!icao.empty()) stations.push_back(raw_station(icao, options_.grids.get()));
    }
    return stations;
}

// Returns the start of the oldest volume whose file exists. Rows of deleted files may stay forever,
// so a list without a beginning starts here.
Result<std::optional<UtcTime>> CatalogRawFiles::floor_of(const CatalogReader& catalog,
                                                         std::string_view station) {
    const auto now = steady_clock::now();
    {
        const MutexLock lock(mutex_);
        const auto known = floors_.find(station);
        if (known != floors_.end() && now - known->second.found < floor_holds_for) {
            return known->second.start;
        }
    }
    const auto oldest = catalog.oldest_kept(station);
    if (!oldest) return oldest;
    const MutexLock lock(mutex_);
    floors_.insert_or_assign(std::string{station}, Floor{*oldest, now});
    return oldest;
}

Result<std::vector<CatalogEntry>> CatalogRawFiles::rows_of(const CatalogReader& catalog,
                                                           std::string_view station,
                                                           const RawRange& range) {
    catalog::Stretch stretch = of_served;
    stretch.from = range.from;
    stretch.to = range.to;
    stretch.newest_first = range.newest_first;
    stretch.most = range.most == 1 ? 16 : range.most + more_rows;
    const bool is_short = range.from && range.to && *range.to - *range.from <= std::chrono::days{2};
    if (!is_short) {
        const auto floor = floor_of(catalog, station);
        if (!floor) return pass_on(floor);
        if (!*floor) return std::vector<CatalogEntry>{};
        stretch.from = std::max(stretch.from.value_or(**floor), **floor);
    }
    auto rows = catalog.list_stretch(station, stretch);
    if (rows && rows->size() == stretch.most) {
        // The limit may have cut off further files with the last name, so leave this name to the
        // next list.
        const std::string last = format_compact(*rows->back().volume.start_time);
        const auto first_of_last = std::ranges::find_if(*rows, [&](const CatalogEntry& row) {
            return format_compact(*row.volume.start_time) == last;
        });
        if (first_of_last != rows->begin()) rows->erase(first_of_last, rows->end());
    }
    return rows;
}

Result<std::vector<RawVolume>> CatalogRawFiles::list(std::string_view station,
                                                     const RawRange& range) {
    std::vector<RawVolume> volumes;
    const auto catalog = reader();
    if (!catalog || !is_icao(station)) return volumes;
    const auto rows = rows_of(*catalog, station, range);
    if (!rows && rows.error().code == ErrorCode::not_found) return volumes;
    if (!rows) return pass_on(rows);
    std::map<std::string, const CatalogEntry*, std::less<>> best;
    for (const CatalogEntry& row : *rows) {
        const CatalogEntry*& known = best[name_of_entry(row)];
        if (known == nullptr || is_better_raw(row, *known)) known = &row;
    }
    for (const auto& [name, row] : best)
        volumes.push_back(volume_of(*row));
    if (range.newest_first) std::ranges::reverse(volumes);
    if (volumes.size() > range.most) volumes.resize(range.most);
    if (!range.with_sizes) return volumes;
    for (RawVolume& volume : volumes) {
        const auto facts = opener_.facts_of(*catalog, *best.find(volume.name)->second);
        if (!facts) return pass_on(facts);
        volume.size_bytes = facts->size_bytes;
        volume.modified = facts->modified;
        volume.tag = facts->tag;
    }
    return volumes;
}

Result<std::optional<CatalogEntry>> CatalogRawFiles::find_by_own_name(const CatalogReader& catalog,
                                                                      std::string_view station,
                                                                      std::string_view name) {
    const auto drop = catalog.drop_directory();
    std::optional<CatalogEntry> gone;
    if (drop) {
        for (const fs::path& path : {*drop / name, *drop / station / name}) {
            auto row = catalog.find_file(station, path);
            if (!row) return row;
            if (!*row || (*row)->state == FileState::rejected) continue;
            if ((*row)->state != FileState::gone) return row;
            gone = std::move(*row);  // another file of this name may exist elsewhere
        }
    }
    const auto time = time_in_file_name(name);
    if (!time) return gone;
    catalog::Stretch stretch = of_served;
    stretch.from = *time - own_name_differs;
    stretch.to = *time + own_name_differs;
    stretch.most = most_rows_of_a_name;
    stretch.with_gone = true;
    const auto rows = catalog.list_stretch(station, stretch);
    if (!rows) return pass_on(rows);
    std::optional<CatalogEntry> found;
    for (const CatalogEntry& row : *rows) {
        if (row.path.filename() != name) continue;
        if (!found || is_better_raw(row, *found)) found = row;
    }
    return found ? found : gone;
}

Result<std::optional<CatalogEntry>> CatalogRawFiles::find(const CatalogReader& catalog,
                                                          std::string_view station,
                                                          std::string_view name) {
    std::optional<CatalogEntry> found;
    if (const auto time = time_of_raw_name(station, name)) {
        catalog::Stretch stretch = of_served;
        stretch.from = *time;
        stretch.to = *time + std::chrono::milliseconds{999};
        stretch.most = most_rows_of_a_name;
        stretch.with_gone = stretch.with_later = true;
        const auto rows = catalog.list_stretch(station, stretch);
        if (!rows) return pass_on(rows);
        for (const CatalogEntry& row : *rows) {
            const bool is_it = is_volume_name(station, name) || name_of_entry(row) == name;
            if (!is_it) continue;
            if (!found || is_better_raw(row, *found)) found = row;
        }
    }
    if (found) return found;
    auto own = find_by_own_name(catalog, station, name);
    if (!own || !*own || (*own)->volume.start_time) return own;
    // This file was found by its path, and is not cataloged as a volume. Members of archives are
    // not served.
    if (!member_names_in((*own)->path).empty()) return std::optional<CatalogEntry>{};
    return own;
}

OpenedOrMissing CatalogRawFiles::open(std::string_view station, std::string_view name) {
    const auto catalog = reader();
    const auto nothing = [&](RawMissing why, std::string reason) {
        return tl::unexpected(RawFailure{why, std::move(reason)});
    };
    if (!catalog || !is_icao(station)) return nothing(RawMissing::unknown, "no such station");
    const auto found = find(*catalog, station, name);
    if (!found && found.error().code == ErrorCode::not_found) {
        return nothing(RawMissing::unknown, found.error().message);
    }
    if (!found) return nothing(RawMissing::trouble, found.error().message);
    if (!*found) return nothing(RawMissing::unknown, "no such volume");
    const CatalogEntry& entry = **found;
    if (entry.state == FileState::gone) {
        return nothing(RawMissing::gone, entry.path.native() + ": is deleted");
    }
    auto opened = opener_.open(*catalog, entry);
    if (!opened) return tl::unexpected(std::move(opened.error()));
    OpenedVolume volume;
    if (entry.volume.start_time) {
        volume.volume = volume_of(entry);
    } else {
        volume.volume.station = station;
        volume.volume.name = name;
        volume.volume.grows = !catalog::has_final_hash(entry);
    }
    volume.volume.size_bytes = opened->size_bytes;
    volume.volume.modified = opened->modified;
    volume.volume.tag = opened->tag;
    if (opened->size_bytes > 0) {
        volume.bytes.emplace_back(FileSlice{opened->file, 0, opened->size_bytes,
                                            opened->is_joined ? opened->size_bytes : 0});
    }
    if (!volume.volume.grows && !opened->is_joined) {
        keep_open(fmt::format("{}/{}", station, name), volume, *opened->file);
    }
    return volume;
}

void CatalogRawFiles::keep_open(const std::string& key, const OpenedVolume& volume,
                                const Descriptor& file) {
    KeptOpen kept{volume, {}, steady_clock::now()};
    if (::fstat(file.number(), &kept.facts) != 0) return;
    const MutexLock lock(mutex_);
    if (open_.size() >= options_.most_open) {
        std::erase_if(open_, [&](const auto& one) {
            return kept.opened - one.second.opened > kept_open_for;
        });
        if (open_.size() >= options_.most_open) return;
    }
    open_.insert_or_assign(key, std::move(kept));
}

std::optional<OpenedVolume> CatalogRawFiles::open_kept(std::string_view station,
                                                       std::string_view name) {
    const std::string key = fmt::format("{}/{}", station, name);
    const MutexLock lock(mutex_);
    const auto known = open_.find(key);
    if (known == open_.end()) return std::nullopt;
    const KeptOpen& kept = known->second;
    const auto* const slice =
        kept.volume.bytes.empty() ? nullptr : std::get_if<FileSlice>(&kept.volume.bytes.front());
    struct stat now {};
    const bool is_same = slice != nullptr && ::fstat(slice->file->number(), &now) == 0 &&
                         now.st_size == kept.facts.st_size && now.st_nlink == kept.facts.st_nlink &&
                         now.st_ctim.tv_sec == kept.facts.st_ctim.tv_sec &&
                         now.st_ctim.tv_nsec == kept.facts.st_ctim.tv_nsec;
    if (!is_same || steady_clock::now() - kept.opened > kept_open_for) {
        open_.erase(known);
        return std::nullopt;
    }
    return kept.volume;
}

}  // namespace

std::string name_of_entry(const CatalogEntry& entry) {
    const bool chunks = pipeline::is_of_chunks(entry);
    return raw_name(entry.station, *entry.volume.start_time,
                    chunks ? std::string{} : entry.path.filename().string());
}

std::optional<std::string> given_name(const CatalogEntry& entry) {
    const bool is_given = entry.volume.start_time && entry.state != FileState::gone &&
                          member_names_in(entry.path).empty();
    if (!is_given) return std::nullopt;
    std::string own = entry.path.filename().string();
    const auto time = time_in_file_name(own);
    const bool is_found = time && *time >= *entry.volume.start_time - own_name_differs &&
                          *time <= *entry.volume.start_time + own_name_differs;
    return is_found && !pipeline::is_of_chunks(entry) ? own : name_of_entry(entry);
}

std::shared_ptr<RawFiles> RawFiles::open_catalog(RawFilesOptions options) {
    return std::make_shared<CatalogRawFiles>(std::move(options));
}

}  // namespace stormcellar::web
