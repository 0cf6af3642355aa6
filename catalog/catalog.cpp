#include "stormcellar/catalog/catalog.h"

#include <algorithm>
#include <utility>

#include "base/beneath.h"
#include "catalog/catalog_parts.h"
#include "catalog/drop_directory.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_left_alone_named = 5;

// Checks the station of a user's query. A name in lower case is an error.
Status check_asked_for(std::string_view station) {
    if (station.empty() || is_icao(station)) return {};
    return fail(ErrorCode::bad_argument,
                "'{}' is not a station: give four capital letters or digits, as in KTLX", station);
}

// Returns the time of the last write to the database.
fs::file_time_type written_last(const fs::path& database) {
    fs::file_time_type newest = fs::file_time_type::min();
    for (const char* ending : {"", "-wal"}) {
        std::error_code error;
        const auto time = fs::last_write_time(database.native() + ending, error);
        if (!error) newest = std::max(newest, time);
    }
    return newest;
}

}  // namespace

CatalogReader::CatalogReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CatalogReader::CatalogReader(CatalogReader&&) noexcept = default;
CatalogReader& CatalogReader::operator=(CatalogReader&&) noexcept = default;
CatalogReader::~CatalogReader() = default;

CatalogWriter::CatalogWriter(std::unique_ptr<Impl> impl) : CatalogReader(std::move(impl)) {}

const fs::path& CatalogReader::directory() const {
    return impl().directory;
}

Status admit_existing(const fs::path& directory, StationRule& rule) {
    if (rule.kind() != StationRule::Kind::any) return {};
    std::error_code ignored;
    if (!fs::exists(directory, ignored)) return {};
    auto names = database_names(directory);
    if (!names) return pass_on(names);
    std::vector<std::pair<fs::file_time_type, std::string>> by_time;
    for (std::string& name : *names) {
        if (name == unknown_station || rule.knows(name)) continue;
        const fs::path path = directory / (name + std::string{database_ending});
        by_time.emplace_back(written_last(path), std::move(name));
    }
    std::sort(by_time.rbegin(), by_time.rend());
    for (const auto& [time, name] : by_time) {
        if (!rule.admits(name)) break;
    }
    return {};
}

Result<CatalogWriter> CatalogWriter::open(fs::path directory, CatalogOptions options) {
    std::error_code error;
    const bool created = fs::create_directories(directory, error);
    if (error) return fail(ErrorCode::io, "{}: {}", directory.native(), error.message());
    if (created) {
        // Sync the new directory's entry in its parent, and the parent's own entry. If the path
        // ends with a slash, the parent's entry is not synced. SQLite syncs only the directory
        // itself.
        const fs::path parent = fs::absolute(directory).lexically_normal().parent_path();
        for (const fs::path& above : {parent, parent.parent_path()}) {
            if (Status synced = real_file_system().sync_directory(above); !synced) {
                return pass_on(synced);
            }
        }
    }
    if (!options.drop.empty()) {
        Status written = write_drop_directory(directory, options.drop);
        // If the disk is full, continue, because readers can work without this file.
        if (!written && written.error().code != ErrorCode::no_space) return pass_on(written);
    }
    if (options.stations) {
        if (Status admitted = admit_existing(directory, *options.stations); !admitted) {
            return pass_on(admitted);
        }
    }
    return CatalogWriter(std::make_unique<Impl>(std::move(directory), std::move(options), true));
}

Result<CatalogReader> CatalogReader::open(fs::path directory, std::size_t most_open) {
    std::error_code ignored;
    if (!fs::is_directory(directory, ignored)) {
        return fail(ErrorCode::not_found, "{}: there is no catalog here", directory.native());
    }
    CatalogOptions options;
    options.most_open = most_open;
    return CatalogReader(std::make_unique<Impl>(std::move(directory), std::move(options), false));
}

// Deletes the rows of the path in other databases, after the row in the database `name` was
// written. Fails if the list of databases cannot be read, or if a row that is known to exist cannot
// be deleted. Does not fail if a database that may have a row cannot be read.
Status CatalogWriter::forget_elsewhere(const fs::path& path, const std::string& name) {
    const auto home = impl().homes.exchange(path, name);
    if (home && (home->empty() || *home == name)) return {};
    const auto names = impl().names_that_may_have(path);
    Status outcome = names ? Status{} : pass_on(names);
    bool is_alone = names.has_value();
    for (const std::string& other : names ? *names : std::vector<std::string>{}) {
        if (other == name) continue;
        bool has_row = home == other;
        const auto forgotten = impl().with_neighbor(other, [&](StationDatabase& database) {
            has_row = database.is_settled(path, 0, 0).has_value();
            if (has_row) database.forget(path);
            return true;
        });
        is_alone = is_alone && forgotten;
        if (!forgotten && has_row && forgotten.error().code != ErrorCode::not_found) {
            outcome = pass_on(forgotten);
        }
    }
    if (!is_alone) impl().homes.forget(path);
    return outcome;
}

Status CatalogWriter::note_file(const FileFacts& facts) {
    const std::string name = impl().name_for(facts.station);
    const auto noted = impl().with(name, true, [&](StationDatabase& database) {
        impl().expect_row(facts.path, name);
        if (database.is_settled(facts.path, 0, 0)) return Registered::unchanged;
        return database.register_file(facts);
    });
    if (!noted) {
        // A file that is for the database of unknown stations may turn out to belong to another
        // database. So the file need not wait for the database of unknown stations, unless the disk
        // is full.
        const bool is_other_trouble =
            name == unknown_station && noted.error().code != ErrorCode::no_space;
        return is_other_trouble ? Status{} : pass_on(noted);
    }
    if (*noted == Registered::left_out || impl().homes.set_if_free(facts.path, name)) return {};
    // Another thread has read the file in the meantime and registered it in another database, so
    // delete the row that was just written.
    const auto forgotten = impl().with(name, false, [&](StationDatabase& database) {
        database.forget(facts.path);
        return true;
    });
    if (!forgotten) return pass_on(forgotten);
    return {};
}

Result<Registered> CatalogWriter::register_file(const FileFacts& facts) {
    const std::string name = impl().name_for(facts.station);
    auto registered = impl().with(name, true, [&](StationDatabase& database) {
        impl().expect_row(facts.path, name);
        return database.register_file(facts);
    });
    if (!registered) return registered;
    // An earlier file at this path may have a row in the database of another station, or of unknown
    // stations.
    if (Status alone = forget_elsewhere(facts.path, name); !alone) return pass_on(alone);
    if (*registered == Registered::left_out) impl().homes.forget(facts.path);
    return registered;
}

Status CatalogWriter::register_files(const std::string& station,
                                     const std::vector<FileFacts>& files) {
    const std::string name = impl().name_for(station);
    const auto left_out = impl().with(name, true, [&](StationDatabase& database) {
        for (const FileFacts& file : files)
            impl().expect_row(file.path, name);
        return database.register_files(files);
    });
    if (!left_out) return pass_on(left_out);
    for (const FileFacts& file : files) {
        if (Status alone = forget_elsewhere(file.path, name); !alone) return alone;
    }
    for (const fs::path& path : *left_out)
        impl().homes.forget(path);
    return {};
}

Result<int> CatalogWriter::mark_gone(const fs::path& path) {
    const auto home = impl().homes.of(path);
    if (home && home->empty()) return 0;
    const std::string likely = home.value_or(std::string{impl().home_of(path.native())});
    const auto names = home ? Result<std::vector<std::string>>{std::vector<std::string>{*home}}
                            : impl().names_that_may_have(path);
    if (!names) return pass_on(names);
    int marked = 0;
    for (const std::string& name : *names) {
        // A read is cheaper than the start of a write.
        const auto mark = [&](StationDatabase& database) {
            return database.is_settled(path, 0, 0) ? database.mark_gone({path}) : 0;
        };
        const bool is_its_own = name == likely && (home || name != unknown_station);
        const auto here =
            is_its_own ? impl().with(name, false, mark) : impl().with_neighbor(name, mark);
        if (!here && is_its_own && here.error().code != ErrorCode::not_found) return pass_on(here);
        marked += here.value_or(0);
    }
    return marked;
}

Result<std::optional<bool>> CatalogReader::find_settled(const fs::path& path,
                                                        std::uint64_t size_bytes,
                                                        std::int64_t modified_ns) const {
    const auto ask = [&](StationDatabase& database) {
        return database.is_settled(path, size_bytes, modified_ns);
    };
    const auto home = impl().homes.of(path);
    if (home && home->empty()) return std::optional<bool>{};
    const std::string guess = home.value_or(std::string{impl().home_of(path.native())});
    // If the path names no station, do not return an error of the database of unknown stations,
    // because the file may belong to another database.
    const bool is_its_own = home || guess != unknown_station;
    auto guessed = is_its_own ? impl().with(guess, false, ask) : impl().with_neighbor(guess, ask);
    if (guessed && guessed->has_value()) return guessed;
    const bool is_missing = !guessed && guessed.error().code == ErrorCode::not_found;
    if (!guessed && !is_missing && is_its_own) return guessed;
    if (home) return std::optional<bool>{};

    const auto names = impl().names_that_may_have(path);
    if (!names) return pass_on(names);
    bool is_sure = guessed || is_missing;
    for (const std::string& name : *names) {
        if (name == guess) continue;
        auto here = impl().with_neighbor(name, ask);
        if (here && here->has_value()) return here;
        is_sure = is_sure && here;
    }
    if (is_sure && impl().writing) impl().homes.set_none(path);
    return std::optional<bool>{};
}

Result<bool> CatalogReader::is_settled(const fs::path& path, std::uint64_t size_bytes,
                                       std::int64_t modified_ns) const {
    const auto found = find_settled(path, size_bytes, modified_ns);
    if (!found) return pass_on(found);
    return found->value_or(false);
}

Result<bool> CatalogReader::is_known(const fs::path& path) const {
    const auto found = find_settled(path, 0, 0);
    if (!found) return pass_on(found);
    return found->has_value();
}

Result<std::vector<std::string>> CatalogReader::station_names() const {
    auto names = impl().names();
    if (!names) return names;
    for (std::string& name : *names)
        name = station_of(name);
    std::sort(names->begin(), names->end());
    return names;
}

Result<LeftAlone> CatalogWriter::left_alone() const {
    LeftAlone found;
    const auto all = database_names(impl().directory);
    if (!all) return pass_on(all);
    for (const std::string& name : *all) {
        if (name == unknown_station || impl().knows(name)) continue;
        if (found.count++ < most_left_alone_named) found.some.push_back(name);
    }
    return found;
}

std::vector<Trouble> CatalogReader::troubles() const {
    return impl().troubles();
}

Result<fs::path> CatalogReader::drop_directory() const {
    return read_drop_directory(impl().directory);
}

std::size_t CatalogReader::open_databases() const {
    return impl().databases.open_count();
}

Status CatalogWriter::examine_all() {
    const auto stations = station_names();
    if (!stations) return pass_on(stations);
    Status outcome;
    for (const std::string& station : *stations) {
        if (Status examined = examine(station); !examined) outcome = std::move(examined);
    }
    return outcome;
}

Status CatalogWriter::examine(std::string_view station) {
    const auto names = impl().names();
    if (!names) return pass_on(names);
    const auto name = std::find_if(names->begin(), names->end(), [&](const std::string& each) {
        return station_of(each) == station;
    });
    if (name == names->end()) return {};
    // Let the writer complete a write or a repair that a crash interrupted.
    const auto opened = impl().with(*name, false, [](StationDatabase&) { return true; });
    if (!opened) return pass_on(opened);
    const fs::path path = impl().path_of(*name);
    const auto found = examine_database(path);
    if (!found) return pass_on(found);
    if (found->damage.empty()) return {};
    const OpenDatabases::Lease place = impl().databases.lease(*name);
    const MutexLock lock(place->mutex);
    if (impl().mend(*place, *name)) return {};
    return fail(ErrorCode::corrupt, "{}: {}; it cannot be mended", path.native(),
                found->damage.front());
}

std::vector<Repair> CatalogWriter::take_repairs() {
    std::vector<Repair> repairs;
    {
        const MutexLock lock(impl().repairs_mutex);
        repairs = std::exchange(impl().repairs, {});
    }
    if (!repairs.empty()) read_archives_again();
    return repairs;
}

void CatalogWriter::read_archives_again() {
    const auto names = impl().names();
    for (const std::string& name : names ? *names : std::vector<std::string>{}) {
        (void)impl().with(name, false, [](StationDatabase& database) {
            database.read_archives_again();
            return true;
        });
    }
}

Result<std::vector<StationSummary>> CatalogReader::stations() const {
    const auto names = impl().names();
    if (!names) return pass_on(names);
    std::vector<StationSummary> summaries;
    for (const std::string& name : *names) {
        auto summary =
            impl().with(name, false, [](StationDatabase& database) { return database.summary(); });
        if (summary) summaries.push_back(std::move(*summary));
    }
    return summaries;
}

// Runs a user's query on the database of a station.
template <class Work>
auto CatalogReader::ask(std::string_view station, Work work) const {
    using Answer = decltype(impl().with(std::string{}, false, work));
    if (Status asked = check_asked_for(station); !asked) return Answer{pass_on(asked)};
    if (!station.empty() && !impl().knows(station)) {
        return Answer{fail(ErrorCode::not_found, "{}: the catalog knows no station {}",
                           impl().directory.native(), station)};
    }
    return impl().with(impl().name_for(station), false, std::move(work));
}

Result<std::vector<CatalogEntry>> CatalogReader::list(std::string_view station,
                                                      const Query& query) const {
    return ask(station, [&](StationDatabase& database) { return database.list(query); });
}

Result<std::optional<CatalogEntry>> CatalogReader::latest(std::string_view station) const {
    return ask(station, [](StationDatabase& database) { return database.first(true); });
}

Result<std::optional<CatalogEntry>> CatalogReader::oldest(std::string_view station) const {
    return ask(station, [](StationDatabase& database) { return database.first(false); });
}

Result<std::vector<CatalogEntry>> CatalogReader::list_stretch(std::string_view station,
                                                              const Stretch& stretch) const {
    return ask(station, [&](StationDatabase& database) { return database.list_stretch(stretch); });
}

Result<std::optional<UtcTime>> CatalogReader::oldest_kept(std::string_view station) const {
    return ask(station, [](StationDatabase& database) { return database.oldest_kept(); });
}

Result<std::vector<CatalogEntry>> CatalogReader::files_with_prefix(std::string_view station,
                                                                   std::string_view prefix,
                                                                   std::size_t most) const {
    return ask(station,
               [&](StationDatabase& database) { return database.files_with_prefix(prefix, most); });
}

Result<std::optional<CatalogEntry>> CatalogReader::find_file(std::string_view station,
                                                             const fs::path& path) const {
    return ask(station, [&](StationDatabase& database) { return database.find_file(path); });
}

}  // namespace stormcellar::catalog
