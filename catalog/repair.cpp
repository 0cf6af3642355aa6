#include "stormcellar/catalog/repair.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include "catalog/salvage.h"
#include "catalog/schema.h"
#include "catalog/station_database.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/base/member_name.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_lines = 20;

std::set<std::string> schema_of(SQLite::Database& database) {
    std::set<std::string> all;
    SQLite::Statement rows(database,
                           "SELECT type || ' ' || name || ' ' || ifnull(sql, '') FROM "
                           "sqlite_schema WHERE name NOT LIKE 'sqlite_stat%'");
    while (rows.executeStep())
        all.insert(rows.getColumn(0).getString());
    return all;
}

std::set<std::string> schema_wanted() {
    SQLite::Database memory(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    memory.exec(create_version_1);
    return schema_of(memory);
}

// Collects SQLite's own findings about pages, indices and constraints.
void check_integrity(SQLite::Database& database, std::vector<std::string>& damage) {
    SQLite::Statement rows(database, fmt::format("PRAGMA integrity_check({})", most_lines));
    while (rows.executeStep()) {
        std::string line = rows.getColumn(0).getString();
        if (line != "ok") damage.push_back(std::move(line));
    }
}

void check_references(SQLite::Database& database, std::vector<std::string>& damage) {
    const auto complain = [&](const char* query, std::string_view what) {
        const int count = database.execAndGet(query).getInt();
        if (count > 0) damage.push_back(fmt::format("{} {}", count, what));
    };
    complain("SELECT count(*) FROM pragma_foreign_key_check", "rows refer to missing rows");
    complain("SELECT count(*) FROM volume WHERE id NOT IN (SELECT volume_id FROM part)",
             "volumes belong to no file");
}

Examination examine(SQLite::Database& database) {
    Examination found;
    const int version = database.execAndGet("PRAGMA user_version").getInt();
    const int id = database.execAndGet("PRAGMA application_id").getInt();
    const std::set<std::string> schema = schema_of(database);
    if (schema.empty()) return found;  // the database was created but not filled yet
    const bool ours = schema == schema_wanted();
    if (!ours && (id != application_id || version > schema_version)) {
        found.foreign = true;
        found.damage.push_back(id == application_id ? "was made by a later version of this software"
                                                    : "is not a catalog of this software");
        return found;
    }
    if (!ours) found.damage.emplace_back("has missing or unknown tables or indices");
    if (id != application_id || version != schema_version) {
        found.damage.push_back(fmt::format("has the numbers {:#x} and {}, not {:#x} and {}", id,
                                           version, application_id, schema_version));
    }
    check_integrity(database, found.damage);
    if (found.damage.empty()) check_references(database, found.damage);
    return found;
}

bool is_there(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

// Returns the first free name for a damaged database. The name does not end in .sqlite, so the file
// no longer counts as a database of the catalog.
fs::path name_aside(const fs::path& path) {
    const std::string stem = path.native() + ".damaged-" + format_compact(now_utc());
    fs::path name = stem;
    for (int number = 2; is_there(name); ++number)
        name = fmt::format("{}-{}", stem, number);
    return name;
}

// Returns the path at which the new database is made before it replaces the damaged database. If
// the damaged database is gone, the new database at this path is complete.
fs::path mending_of(const fs::path& path) {
    return path.native() + ".mending";
}

}  // namespace

Result<Examination> examine_database(const fs::path& path) {
    auto opened = StationDatabase::open_connection(path);
    if (!opened) {
        if (opened.error().code != ErrorCode::corrupt) return pass_on(opened);
        return Examination{{opened.error().message}, false};
    }
    try {
        return examine(**opened);
    } catch (const SQLite::Exception& error) {
        if (code_of(error) != ErrorCode::corrupt) {
            return fail(code_of(error), "{}: {}", path.native(), error.what());
        }
        return Examination{{error.what()}, false};
    }
}

namespace {

// Makes the new database, with the rows of files that are gone, at mending_of(path).
Status make_new(const fs::path& path, const Salvage& salvaged, Repair& repair) {
    const fs::path mending = mending_of(path);
    for (const char* ending : {"", "-wal", "-shm"}) {  // remove leftovers of an interrupted repair
        const fs::path left = mending.native() + ending;
        if (!is_there(left)) continue;
        if (Status removed = real_file_system().remove(left); !removed) return removed;
    }
    std::vector<SalvagedFile> gone;
    for (const SalvagedFile& file : salvaged.files) {
        const auto members = member_names_in(file.facts.path);
        const bool is_in_archive = std::ranges::any_of(
            members, [](const MemberName& name) { return is_there(name.archive); });
        if (is_in_archive || is_there(file.facts.path)) {
            ++repair.to_read_again;
        } else {
            gone.push_back(file);
        }
    }
    auto fresh = StationDatabase::open_for_writing(mending, repair.station);
    if (!fresh) return pass_on(fresh);
    try {
        (*fresh)->restore_gone(gone);
    } catch (const SQLite::Exception& error) {
        return fail(code_of(error), "{}: {}", mending.native(), error.what());
    }
    repair.kept_gone = static_cast<std::int64_t>(gone.size());
    repair.lost = salvaged.unread_files;
    return {};
}

}  // namespace

Status adopt_mended_database(const fs::path& path) {
    const fs::path mending = mending_of(path);
    if (is_there(path) || !is_there(mending)) return {};
    // The damaged database's WAL must not be used with the new database.
    FileSystem& disk = real_file_system();
    const fs::path aside = name_aside(path);
    for (const char* ending : {"-wal", "-shm"}) {
        const fs::path left = path.native() + ending;
        if (!is_there(left)) continue;
        if (Status moved = disk.rename(left, aside.native() + ending); !moved) return moved;
    }
    if (Status moved = disk.rename(mending, path); !moved) return moved;
    return disk.sync_directory(path.parent_path());
}

// Makes the new database first, so that either the damaged or the complete new database exists at
// any instant.
Result<Repair> repair_database(const fs::path& path, const std::string& station,
                               const std::string& damage) {
    Repair repair;
    repair.station = station;
    repair.database = path;
    repair.damage = damage;
    if (Status made = make_new(path, salvage(path), repair); !made) return pass_on(made);
    repair.set_aside = name_aside(path);
    FileSystem& disk = real_file_system();
    if (Status synced = disk.sync_directory(path.parent_path()); !synced) return pass_on(synced);
    if (Status moved = disk.rename(path, repair.set_aside); !moved) return pass_on(moved);
    if (Status adopted = adopt_mended_database(path); !adopted) return pass_on(adopted);
    return repair;
}

std::string describe(const Repair& repair) {
    if (repair.set_aside.empty()) {
        return fmt::format("{}: {}; a new database is made from the files",
                           repair.database.native(), repair.damage);
    }
    return fmt::format(
        "{}: was damaged ({}) and is set aside as {}; a new database keeps {} rows of files that "
        "are gone, {} rows are made again from their files, {} could not be read",
        repair.database.native(), repair.damage, repair.set_aside.filename().native(),
        repair.kept_gone, repair.to_read_again,
        repair.lost == 0 ? std::string{"none"} : fmt::format("at most {}", repair.lost));
}

}  // namespace stormcellar::catalog
