#include "catalog/station_database.h"

#include <algorithm>
#include <span>
#include <utility>

#include "catalog/sql_values.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

// Returns the bytes, which are valid until the next step of the statement.
std::string_view bytes_of(const SQLite::Column& blob) {
    const auto* const bytes = static_cast<const char*>(blob.getBlob());
    return {bytes, bytes == nullptr ? 0 : static_cast<std::size_t>(blob.getBytes())};
}

template <class T>
void bind_optional(SQLite::Statement& statement, int index, const std::optional<T>& value) {
    if (value) {
        statement.bind(index, *value);
    } else {
        statement.bind(index);
    }
}

}  // namespace

LentStatement StationDatabase::prepared(const char* sql) {
    return LentStatement(statements_.try_emplace(sql, database_, sql).first->second);
}

std::int64_t StationDatabase::store_volume(std::int64_t file_id, std::uint64_t content_hash,
                                           const VolumeFacts& facts) {
    const std::int64_t start = *milliseconds(facts.start_time);
    // If another file with the same contents has this volume, use that volume's row.
    LentStatement same = prepared(
        "SELECT v.id FROM volume v JOIN part p ON p.volume_id = v.id "
        "JOIN file f ON f.id = p.file_id "
        "WHERE v.start_ms = ? AND ifnull(v.number, -1) = ? "
        "AND f.content_hash = ? AND f.id <> ?");
    same->bind(1, start);
    same->bind(2, facts.volume_number.value_or(-1));
    same->bind(3, static_cast<std::int64_t>(content_hash));
    same->bind(4, file_id);
    if (same->executeStep()) return same->getColumn(0).getInt64();

    LentStatement next = prepared(
        "SELECT ifnull(max(generation) + 1, 0) FROM volume "
        "WHERE start_ms = ? AND ifnull(number, -1) = ?");
    next->bind(1, start);
    next->bind(2, facts.volume_number.value_or(-1));
    next->executeStep();
    return insert_volume(facts, next->getColumn(0).getInt());
}

std::int64_t StationDatabase::insert_volume(const VolumeFacts& facts, int generation) {
    LentStatement insert = prepared(
        "INSERT INTO volume (start_ms, end_ms, number, generation, vcp, sweep_count, "
        "radial_count, complete) VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
    insert->bind(1, *milliseconds(facts.start_time));
    bind_optional(*insert, 2, milliseconds(facts.end_time));
    bind_optional(*insert, 3, facts.volume_number);
    insert->bind(4, generation);
    bind_optional(*insert, 5, facts.vcp);
    insert->bind(6, facts.sweep_count);
    insert->bind(7, facts.radial_count);
    insert->bind(8, facts.complete ? 1 : 0);
    insert->exec();
    return database_.getLastInsertRowid();
}

void StationDatabase::insert_part(std::int64_t file_id, int ordinal, std::int64_t volume_id) {
    LentStatement part = prepared("INSERT INTO part VALUES (?, ?, ?)");
    part->bind(1, file_id);
    part->bind(2, ordinal);
    part->bind(3, volume_id);
    part->exec();
}

// Sets whether later writes survive a power cut. Rows of settled files must survive, as the files
// may be gone later. But a sync takes milliseconds, too long for a growing file, which is
// registered with every chunk.
void StationDatabase::set_durable(bool durable) {
    if (durable == is_durable_) return;
    database_.exec(durable ? "PRAGMA synchronous = FULL" : "PRAGMA synchronous = NORMAL");
    is_durable_ = durable;
}

Registered StationDatabase::register_file(const FileFacts& facts) {
    set_durable(facts.state != FileState::seen);
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    const Registered registered = register_row(facts);
    if (registered != Registered::unchanged) transaction.commit();
    return registered;
}

std::vector<fs::path> StationDatabase::register_files(const std::vector<FileFacts>& files) {
    set_durable(std::ranges::any_of(
        files, [](const FileFacts& facts) { return facts.state != FileState::seen; }));
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    std::vector<fs::path> left_out;
    for (const FileFacts& facts : files) {
        if (register_row(facts) == Registered::left_out) left_out.push_back(facts.path);
    }
    transaction.commit();
    return left_out;
}

// Returns true if the rows describe the file's volumes as `facts` do. Volumes without a start have
// no rows.
bool StationDatabase::has_these_volumes(std::int64_t file_id,
                                        const std::vector<VolumeFacts>& volumes) {
    LentStatement rows = prepared(
        "SELECT v.start_ms, v.end_ms, v.number, v.vcp, v.sweep_count, v.radial_count, v.complete "
        "FROM part p JOIN volume v ON v.id = p.volume_id WHERE p.file_id = ? ORDER BY p.ordinal");
    rows->bind(1, file_id);
    for (const VolumeFacts& facts :
         std::span{volumes}.first(std::min(volumes.size(), most_volumes_a_file))) {
        if (!facts.start_time) continue;
        const bool is_same = rows->executeStep() &&
                             optional_time(rows->getColumn(0)) == facts.start_time &&
                             optional_time(rows->getColumn(1)) == facts.end_time &&
                             optional_int(rows->getColumn(2)) == facts.volume_number &&
                             optional_int(rows->getColumn(3)) == facts.vcp &&
                             rows->getColumn(4).getInt() == facts.sweep_count &&
                             rows->getColumn(5).getInt() == facts.radial_count &&
                             (rows->getColumn(6).getInt() != 0) == facts.complete;
        if (!is_same) return false;
    }
    return !rows->executeStep();
}

// Call it inside a transaction.
std::optional<std::int64_t> StationDatabase::find_file(const FileFacts& facts, bool& is_same) {
    LentStatement known = prepared(
        "SELECT id, size_bytes, modified_ns, content_hash, state, reason "
        "FROM file WHERE path = ?");
    bind_path(*known, 1, facts.path);
    if (!known->executeStep()) return std::nullopt;
    is_same = known->getColumn(1).getInt64() == static_cast<std::int64_t>(facts.size_bytes) &&
              known->getColumn(2).getInt64() == facts.modified_ns &&
              known->getColumn(3).getInt64() == static_cast<std::int64_t>(facts.content_hash) &&
              known->getColumn(4).getString() == file_state_name(facts.state) &&
              known->getColumn(5).getString() == facts.reason;
    const std::int64_t file_id = known->getColumn(0).getInt64();
    is_same = is_same && has_these_volumes(file_id, facts.volumes);
    return file_id;
}

std::int64_t StationDatabase::write_file(const FileFacts& facts) {
    LentStatement file = prepared(
        "INSERT INTO file (path, size_bytes, modified_ns, content_hash, state, reason, "
        "registered_ms) VALUES (?, ?, ?, ?, ?, ?, ?) ON CONFLICT (path) DO UPDATE SET "
        "size_bytes = excluded.size_bytes, modified_ns = excluded.modified_ns, "
        "content_hash = excluded.content_hash, state = excluded.state, reason = excluded.reason "
        "RETURNING id");
    bind_path(*file, 1, facts.path);
    file->bind(2, static_cast<std::int64_t>(facts.size_bytes));
    file->bind(3, facts.modified_ns);
    file->bind(4, static_cast<std::int64_t>(facts.content_hash));
    file->bind(5, std::string{file_state_name(facts.state)});
    file->bind(6, facts.reason);
    file->bind(7, now_utc().time_since_epoch().count());
    file->executeStep();
    return file->getColumn(0).getInt64();
}

// Removes the parts of the file, and the volumes that are in no other file.
void StationDatabase::drop_volumes(std::int64_t file_id) {
    std::vector<std::int64_t> volumes;
    {
        LentStatement held = prepared("SELECT volume_id FROM part WHERE file_id = ?");
        held->bind(1, file_id);
        while (held->executeStep())
            volumes.push_back(held->getColumn(0).getInt64());
    }
    if (volumes.empty()) return;
    LentStatement drop = prepared("DELETE FROM part WHERE file_id = ?");
    drop->bind(1, file_id);
    drop->exec();
    for (const std::int64_t volume : volumes) {
        LentStatement unheld = prepared(
            "DELETE FROM volume WHERE id = ?1 AND NOT EXISTS "
            "(SELECT 1 FROM part WHERE volume_id = ?1)");
        unheld->bind(1, volume);
        unheld->exec();
    }
}

// Call it inside a transaction.
Registered StationDatabase::register_row(const FileFacts& facts) {
    bool is_same = false;
    const std::optional<std::int64_t> known = find_file(facts, is_same);
    if (is_same) return Registered::unchanged;
    if (!known && !make_room()) return Registered::left_out;
    const std::int64_t file_id = write_file(facts);
    if (facts.state == FileState::gone) may_have_gone_ = true;
    // Describe the volumes of the file anew, so that a growing file does not count as a second file
    // with the volumes of its own earlier state.
    if (known) drop_volumes(file_id);
    int ordinal = 0;
    const std::size_t kept = std::min(facts.volumes.size(), most_volumes_a_file);
    for (const VolumeFacts& volume : std::span{facts.volumes}.first(kept)) {
        // only metadata without a time; there is nothing to look up
        if (!volume.start_time) continue;
        insert_part(file_id, ordinal++, store_volume(file_id, facts.content_hash, volume));
    }
    return known ? Registered::updated : Registered::added;
}

std::int64_t StationDatabase::restore_volume(const SalvagedVolume& volume) {
    SQLite::Statement known(database_,
                            "SELECT id FROM volume WHERE start_ms = ? AND ifnull(number, -1) = ? "
                            "AND generation = ?");
    known.bind(1, *milliseconds(volume.facts.start_time));
    known.bind(2, volume.facts.volume_number.value_or(-1));
    known.bind(3, volume.generation);
    if (known.executeStep()) return known.getColumn(0).getInt64();
    return insert_volume(volume.facts, volume.generation);
}

void StationDatabase::restore_gone(const std::vector<SalvagedFile>& files) {
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    for (const SalvagedFile& salvaged : files) {
        const FileFacts& facts = salvaged.facts;
        SQLite::Statement file(database_,
                               "INSERT OR IGNORE INTO file (path, size_bytes, modified_ns, "
                               "content_hash, state, reason, registered_ms) "
                               "VALUES (?, ?, ?, ?, 'gone', ?, ?)");
        bind_path(file, 1, facts.path);
        file.bind(2, static_cast<std::int64_t>(facts.size_bytes));
        file.bind(3, facts.modified_ns);
        file.bind(4, static_cast<std::int64_t>(facts.content_hash));
        file.bind(5, facts.reason);
        file.bind(6, salvaged.registered_time.time_since_epoch().count());
        if (file.exec() == 0) continue;  // one path has two rows, which only damage causes
        const std::int64_t file_id = database_.getLastInsertRowid();
        int ordinal = 0;
        for (const SalvagedVolume& volume : salvaged.volumes) {
            insert_part(file_id, ordinal++, restore_volume(volume));
        }
    }
    transaction.commit();
}

int StationDatabase::mark_gone(const std::vector<fs::path>& paths) {
    set_durable(true);
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement update(database_,
                             "UPDATE file SET state = 'gone' WHERE path = ? AND state <> 'gone'");
    int marked = 0;
    for (const fs::path& path : paths) {
        bind_path(update, 1, path);
        marked += update.exec();
        update.reset();
    }
    transaction.commit();
    if (marked > 0) may_have_gone_ = true;
    return marked;
}

void StationDatabase::read_archives_again() {
    LentStatement update = prepared(
        "UPDATE file SET modified_ns = ? "
        "WHERE state IN ('complete', 'partial') AND substr(reason, 1, ?) = ?");
    update->bind(1, never_read_ns);
    update->bind(2, static_cast<std::int64_t>(reason_of_archive.size()));
    update->bind(3, std::string{reason_of_archive});  // as text, not as bytes
    update->exec();
}

StationDatabase::Paths StationDatabase::paths_below(const fs::path& directory, std::int64_t after,
                                                    std::int64_t most) {
    const std::string start = directory.native() + "/";
    LentStatement rows =
        prepared("SELECT id, path FROM file WHERE id > ? AND state <> 'gone' ORDER BY id LIMIT ?");
    rows->bind(1, after);
    rows->bind(2, most);
    Paths found;
    while (rows->executeStep()) {
        found.last = rows->getColumn(0).getInt64();
        const std::string_view path = bytes_of(rows->getColumn(1));
        if (path.starts_with(start)) found.paths.emplace_back(path);
        --most;
    }
    found.are_all = most > 0;
    return found;
}

void StationDatabase::forget(const fs::path& path) {
    std::int64_t file_id = 0;
    {
        LentStatement known = prepared("SELECT id FROM file WHERE path = ?");
        bind_path(*known, 1, path);
        if (!known->executeStep()) return;
        file_id = known->getColumn(0).getInt64();
    }
    set_durable(true);
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    drop_volumes(file_id);
    LentStatement remove = prepared("DELETE FROM file WHERE path = ?");
    bind_path(*remove, 1, path);
    remove->exec();
    transaction.commit();
}

bool StationDatabase::look_at_paths(const std::function<void(std::string_view)>& look,
                                    std::int64_t most) {
    {
        LentStatement last = prepared("SELECT ifnull(max(id), 0) FROM file");
        last->executeStep();
        if (last->getColumn(0).getInt64() > most) return false;
    }
    LentStatement rows = prepared("SELECT path FROM file");
    while (rows->executeStep())
        look(bytes_of(rows->getColumn(0)));
    return true;
}

std::optional<bool> StationDatabase::is_settled(const fs::path& path, std::uint64_t size_bytes,
                                                std::int64_t modified_ns) {
    LentStatement row = prepared(
        "SELECT size_bytes = ? AND modified_ns = ? AND "
        "state IN ('complete', 'partial', 'rejected') FROM file WHERE path = ?");
    row->bind(1, static_cast<std::int64_t>(size_bytes));
    row->bind(2, modified_ns);
    bind_path(*row, 3, path);
    if (!row->executeStep()) return std::nullopt;
    return row->getColumn(0).getInt() != 0;
}

}  // namespace stormcellar::catalog
