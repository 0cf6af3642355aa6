#include "catalog/check_catalog.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>

#include <SQLiteCpp/SQLiteCpp.h>
#include <sys/stat.h>

#include "catalog/catalog_parts.h"
#include "catalog/path_homes.h"
#include "catalog/station_database.h"
#include "stormcellar/archive/archive_reader.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/catalog/repair.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

bool is_settled(const std::string& state) {
    return state == "complete" || state == "partial" || state == "rejected";
}

void compare_row(SQLite::Statement& row, StationCheck& check) {
    ++check.files;
    const fs::path path = row.getColumn(0).getString();
    const std::string state = row.getColumn(3).getString();
    if (state == file_state_name(FileState::gone)) {
        ++check.gone;
        return;
    }
    struct stat facts {};
    if (::lstat(path.c_str(), &facts) != 0) {
        // The path of an archive member may be too long for a file; then no file has it.
        const bool is_missing = errno == ENOENT || errno == ENOTDIR || errno == ENAMETOOLONG;
        if (!is_missing) {
            check.unseen.push_back(path);
        } else if (!archive::member_path_of(path)) {  // a member exists if its archive does
            check.missing.push_back(path);
        }
        return;
    }
    const std::int64_t modified_ns =
        std::int64_t{facts.st_mtim.tv_sec} * 1'000'000'000 + std::int64_t{facts.st_mtim.tv_nsec};
    const std::int64_t known_ns = row.getColumn(2).getInt64();
    const bool same = row.getColumn(1).getInt64() == std::int64_t{facts.st_size} &&
                      (known_ns == modified_ns || known_ns == never_read_ns);
    if (is_settled(state) && !same) check.changed.push_back(path);
}

Result<StationCheck> check_station(const fs::path& database) {
    StationCheck check;
    check.database = database;
    const std::string stem = database.stem().native();
    if (stem != unknown_station) check.station = stem;
    auto examined = examine_database(database);
    if (!examined) return pass_on(examined);
    check.damage = std::move(examined->damage);
    if (!check.damage.empty()) return check;
    auto opened = StationDatabase::open_connection(database);
    if (!opened) return pass_on(opened);
    try {
        const bool is_filled =
            (*opened)->execAndGet("SELECT count(*) FROM sqlite_schema").getInt() > 0;
        if (!is_filled) return check;  // a writer has just created the database
        SQLite::Statement rows(
            **opened, "SELECT path, size_bytes, modified_ns, state FROM file ORDER BY path");
        while (rows.executeStep())
            compare_row(rows, check);
    } catch (const SQLite::Exception& error) {
        return fail(code_of(error), "{}: {}", database.native(), error.what());
    }
    return check;
}

}  // namespace

bool CatalogCheck::is_sound() const {
    return troubles.empty() &&
           std::all_of(stations.begin(), stations.end(), [](const StationCheck& check) {
               return check.damage.empty() && check.missing.empty() && check.unseen.empty() &&
                      check.changed.empty();
           });
}

Result<CatalogCheck> check_catalog(const fs::path& directory, std::string_view station,
                                   const StationRule* stations) {
    std::error_code error;
    std::vector<fs::path> databases;
    CatalogCheck found;
    for (fs::directory_iterator entry(directory, error), end; !error && entry != end;
         entry.increment(error)) {
        const fs::path& path = entry->path();
        const std::string stem = path.stem().native();
        const bool is_database = path.extension() == ".sqlite" &&
                                 (is_icao(stem) || stem == unknown_station) &&
                                 (station.empty() || station == stem);
        if (is_database) databases.push_back(path);
        const std::string name = path.filename().native();
        const bool is_aside = name.find(".sqlite.damaged-") != std::string::npos &&
                              !name.ends_with("-wal") && !name.ends_with("-shm") &&
                              (station.empty() || name.starts_with(station));
        if (is_aside) found.set_aside.push_back(path);
    }
    if (error) return fail(ErrorCode::not_found, "{}: {}", directory.native(), error.message());
    if (databases.empty() && !station.empty()) {
        return fail(ErrorCode::not_found, "{}: the catalog knows no station {}", directory.native(),
                    station);
    }
    std::sort(databases.begin(), databases.end());
    std::sort(found.set_aside.begin(), found.set_aside.end());
    for (const fs::path& database : databases) {
        auto check = check_station(database);
        if (check) {
            check->is_known =
                check->station.empty() || stations == nullptr || stations->knows(check->station);
            found.stations.push_back(std::move(*check));
        } else {
            const std::string stem = database.stem().native();
            found.troubles.push_back({station_of(stem), check.error()});
        }
    }
    return found;
}

namespace {

// Counts the rows of a database. Errors: those of check_station(); corrupt if the database is
// damaged, is not a catalog of this software, or was made by a later version.
Result<ClearedDatabase> count_rows(const fs::path& database) {
    const auto check = check_station(database);
    if (!check) return pass_on(check);
    if (!check->damage.empty()) {
        return fail(ErrorCode::corrupt, "{}: {}", database.native(), check->damage.front());
    }
    ClearedDatabase counted{check->station, check->files, 0};
    counted.there = check->files - check->gone - static_cast<std::int64_t>(check->missing.size());
    return counted;
}

Status read_archives_again(const fs::path& directory, const std::string& name) {
    const fs::path path = directory / (name + std::string{database_ending});
    auto database = StationDatabase::open_for_writing(path, station_of(name));
    if (!database) return pass_on(database);
    try {
        (*database)->read_archives_again();
    } catch (const SQLite::Exception& error) {
        return fail(code_of(error), "{}: {}", path.native(), error.what());
    }
    return {};
}

}  // namespace

Result<ClearReport> clear_unknown(const fs::path& directory, const StationRule& stations) {
    const auto names = database_names(directory);
    if (!names) return pass_on(names);
    ClearReport report;
    FileSystem& disk = real_file_system();
    for (const std::string& name : *names) {
        if (name == unknown_station || stations.knows(name)) continue;
        const fs::path database = directory / (name + std::string{database_ending});
        const auto counted = count_rows(database);
        Status removed = counted ? Status{} : pass_on(counted);
        for (const char* ending : {"", "-wal", "-shm"}) {
            if (!removed) break;
            removed = disk.remove(database.native() + ending);
            const bool was_there = removed || removed.error().code != ErrorCode::not_found;
            if (!was_there && *ending != '\0') removed = {};
        }
        if (removed) {
            report.cleared.push_back(*counted);
        } else {
            report.kept.push_back({name, removed.error()});
        }
    }
    if (report.cleared.empty()) return report;
    for (const std::string& name : *names) {
        if (name != unknown_station && !stations.knows(name)) continue;
        if (Status again = read_archives_again(directory, name); !again) return pass_on(again);
    }
    if (Status synced = disk.sync_directory(directory); !synced) return pass_on(synced);
    return report;
}

}  // namespace stormcellar::catalog
