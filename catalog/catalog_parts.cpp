#include "catalog/catalog_parts.h"

#include <algorithm>
#include <limits>
#include <system_error>

#include "stormcellar/base/station_table.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

// A database with at most this many rows is searched for strays (rows of files that are named like
// another station) while a new file waits. The search takes some milliseconds. mark_missing()
// searches larger databases.
constexpr std::int64_t most_looked_through = 10'000;

// A database in trouble is not tried again within this time for files of other stations.
constexpr std::chrono::seconds between_tries{10};

// If a try took longer than this, the database is not tried again within `between_tries` for files
// of its own station, either.
constexpr std::chrono::seconds longest_try{1};

// The number of databases closed when descriptors run out. The freed descriptors are enough to open
// one database, and for what the process does meanwhile.
constexpr std::size_t closed_when_out = 8;

std::string summary_of(const std::vector<std::string>& damage) {
    std::string first = damage.front().substr(0, damage.front().find('\n'));
    if (damage.size() == 1) return first;
    return fmt::format("{}, and {} more", first, damage.size() - 1);
}

}  // namespace

std::string station_of(const std::string& name) {
    return name == unknown_station ? std::string{} : name;
}

Result<std::vector<std::string>> database_names(const fs::path& directory) {
    std::vector<std::string> found;
    std::error_code error;
    for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
         entry.increment(error)) {
        const fs::path& path = entry->path();
        const std::string stem = path.stem().string();
        if (path.extension() == database_ending && (is_icao(stem) || stem == unknown_station)) {
            found.push_back(stem);
        }
    }
    if (error) return fail(ErrorCode::io, "{}: {}", directory.native(), error.message());
    std::sort(found.begin(), found.end());
    return found;
}

bool CatalogReader::Impl::knows(std::string_view station) const {
    return options.stations ? options.stations->knows(station) : is_icao(station);
}

Status CatalogReader::Impl::open(Slot& place, const std::string& name, bool create) {
    const fs::path path = path_of(name);
    // Notice a deleted or replaced database even if it was closed to make room, because the rows
    // that were lost with it must be made again.
    if (place.file != FileIdentity{} && place.file != FileIdentity::of(path)) {
        databases.close(place);  // readers would not see writes to the old file
        place.file = {};
        place.strays = Strays::unknown;
        is_listing_old_ = true;
        if (writing) note_repair({station_of(name), path, {}, "was deleted or replaced"});
    }
    if (place.database) return {};
    if (writing) {
        if (Status adopted = adopt_mended_database(path); !adopted) return adopted;
    }
    std::error_code ignored;
    if (!(writing && create) && !fs::exists(path, ignored)) {
        return fail(ErrorCode::not_found, "{}: the catalog knows no station {}", directory.native(),
                    name);
    }
    databases.make_room(place);
    auto opened = open_database(name);
    if (!opened && is_out_of_descriptors() && databases.close_idle(closed_when_out) > 0) {
        opened = open_database(name);
    }
    if (!opened) {
        databases.close(place);
        if (is_out_of_descriptors()) return no_descriptor(path);
        return pass_on(opened);
    }
    place.database = std::move(*opened);
    if (place.file == FileIdentity{}) is_listing_old_ = true;
    place.file = FileIdentity::of(path);
    return {};
}

Result<std::unique_ptr<StationDatabase>> CatalogReader::Impl::open_database(
    const std::string& name) {
    const fs::path path = path_of(name);
    if (!writing) return StationDatabase::open_for_reading(path, station_of(name));
    auto opened = StationDatabase::open_for_writing(path, station_of(name));
    if (opened) {
        (*opened)->set_most_bytes(name == unknown_station ? options.most_unknown_bytes
                                                          : options.most_station_bytes);
    }
    return opened;
}

bool CatalogReader::Impl::mend(Slot& place, const std::string& name) {
    databases.close(place);
    place.file = {};
    place.strays = Strays::unknown;
    const fs::path path = path_of(name);
    const auto found = examine_database(path);
    if (!found || found->foreign) return false;
    if (found->damage.empty()) return true;
    auto repair = repair_database(path, station_of(name), summary_of(found->damage));
    if (!repair) return false;
    note_repair(std::move(*repair));
    return true;
}

void CatalogReader::Impl::note_outcome(const std::string& name, const Error* error,
                                       std::chrono::steady_clock::time_point began) {
    // A full disk or a missing database is not a trouble of a station.
    const bool is_trouble =
        error != nullptr && error->code != ErrorCode::not_found && !is_shortage(error->code);
    if (!is_trouble && !has_troubles_) return;
    const MutexLock lock(troubles_mutex_);
    if (is_trouble) {
        const auto now = std::chrono::steady_clock::now();
        troubles_.insert_or_assign(name, Standing{*error, began, now});
    } else if (error == nullptr || error->code == ErrorCode::not_found) {
        troubles_.erase(name);
    }
    has_troubles_ = !troubles_.empty();
}

std::vector<Trouble> CatalogReader::Impl::troubles() const {
    const MutexLock lock(troubles_mutex_);
    std::vector<Trouble> found;
    for (const auto& [name, standing] : troubles_)
        found.push_back({station_of(name), standing.error});
    return found;
}

std::optional<CatalogReader::Impl::Standing> CatalogReader::Impl::recently_tried(
    const std::string& name) const {
    if (!has_troubles_) return std::nullopt;
    const MutexLock lock(troubles_mutex_);
    const auto found = troubles_.find(name);
    if (found == troubles_.end()) return std::nullopt;
    const bool is_recent = std::chrono::steady_clock::now() - found->second.tried < between_tries;
    return is_recent ? std::optional{found->second} : std::nullopt;
}

std::optional<Error> CatalogReader::Impl::recent_trouble(const std::string& name) const {
    const auto standing = recently_tried(name);
    return standing ? std::optional{standing->error} : std::nullopt;
}

std::optional<Error> CatalogReader::Impl::slow_trouble(const std::string& name) const {
    const auto standing = recently_tried(name);
    const bool was_slow = standing && standing->tried - standing->began > longest_try;
    return was_slow ? std::optional{standing->error} : std::nullopt;
}

Result<std::vector<std::string>> CatalogReader::Impl::names() {
    auto found = database_names(directory);
    if (!found && is_out_of_descriptors() && databases.close_idle(closed_when_out) > 0) {
        found = database_names(directory);
    }
    if (found) {
        std::erase_if(*found, [&](const std::string& name) {
            return name != unknown_station && !knows(name);
        });
    }
    return found;
}

// If the rule `any` has admitted stations since the last call, lists the databases again, and
// searches the database of unknown stations for strays again: paths there may now belong to an
// admitted station.
void CatalogReader::Impl::look_for_admitted_stations() {
    if (!options.stations || options.stations->kind() != StationRule::Kind::any) return;
    const std::size_t admitted = options.stations->further().size();
    if (std::exchange(admitted_, admitted) == admitted) return;
    is_listing_old_ = true;
    const OpenDatabases::Lease place = databases.lease(std::string{unknown_station});
    const MutexLock lock(place->mutex);
    place->strays = Strays::unknown;
}

Result<std::vector<std::string>> CatalogReader::Impl::names_that_may_have(const fs::path& path) {
    if (!writing) return names();
    std::vector<std::string> found;
    {
        const MutexLock lock(listed_mutex_);
        look_for_admitted_stations();
        if (is_listing_old_.exchange(false) || !listed_) {
            auto now = names();
            if (!now) {
                is_listing_old_ = true;
                return now;
            }
            listed_ = std::move(*now);
        }
        found = *listed_;
    }
    const std::string_view home = home_of(path.native());
    const bool may_be_stray = strays_->may_have(path.native());
    std::erase_if(found, [&](const std::string& name) {
        return name != home && !may_have_stray(name, may_be_stray);
    });
    return found;
}

std::optional<Strays> CatalogReader::Impl::find_strays(StationDatabase& database,
                                                       const std::string& name,
                                                       std::int64_t most_rows) {
    Strays found = Strays::none;
    const bool looked = database.look_at_paths(
        [&](std::string_view path) {
            if (home_of(path) == name) return;
            found = Strays::some;
            if (strays_) strays_->add(path);
        },
        most_rows);
    return looked ? std::optional{found} : std::nullopt;
}

void CatalogReader::Impl::expect_row(const fs::path& path, const std::string& name) {
    if (home_of(path.native()) == name) return;
    if (strays_) strays_->add(path.native());
    databases.lease(name)->strays = Strays::some;
}

void CatalogReader::Impl::look_for_strays(StationDatabase& database, const std::string& name) {
    const OpenDatabases::Lease place = databases.lease(name);
    if (place->strays == Strays::unknown || place->strays == Strays::too_many_rows) {
        place->strays = *find_strays(database, name, std::numeric_limits<std::int64_t>::max());
    }
}

bool CatalogReader::Impl::may_have_stray(const std::string& name, bool is_likely) {
    const OpenDatabases::Lease place = databases.lease(name);
    const auto may_have = [&] {
        return place->strays == Strays::some ? is_likely : place->strays != Strays::none;
    };
    if (place->strays != Strays::unknown) return may_have();
    if (recent_trouble(name)) return true;
    const MutexLock lock(place->mutex);
    const auto began = std::chrono::steady_clock::now();
    // Damage is repaired when the database is used, or when files of its own station come.
    const auto looked = attempt(*place, name, false, [&](StationDatabase& database) {
        if (place->strays != Strays::unknown) return true;  // another thread has searched
        place->strays =
            find_strays(database, name, most_looked_through).value_or(Strays::too_many_rows);
        return true;
    });
    if (!looked && looked.error().code == ErrorCode::not_found) is_listing_old_ = true;
    if (!looked && looked.error().code != ErrorCode::corrupt) {
        note_outcome(name, &looked.error(), began);
    }
    // This path may be one of the strays just found.
    return place->strays != Strays::none;
}

}  // namespace stormcellar::catalog
