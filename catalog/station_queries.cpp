// This file lists and counts the volumes in one station's database.
#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "catalog/sql_values.h"
#include "catalog/station_database.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

// The largest number of entries that a query with a limit returns.
constexpr std::size_t most_listed = 1'000'000;

constexpr const char* entry_columns =
    "SELECT f.path, f.size_bytes, f.state, f.reason, f.registered_ms, v.start_ms, v.end_ms, "
    "v.number, v.vcp, v.sweep_count, v.radial_count, v.complete, v.generation, f.modified_ns, "
    "f.content_hash, p.ordinal ";
// CROSS JOIN fixes the order of the tables, so that SQLite reads volumes in the order of their
// index and stops at the limit of a query. Otherwise it may read a whole table.
constexpr const char* entry_join =
    "FROM volume v CROSS JOIN part p ON p.volume_id = v.id CROSS JOIN file f ON f.id = p.file_id ";
// This SQL is true for paths that do not name a member of an archive: such paths have no
// member_mark, or end with it.
constexpr const char* is_no_member = "instr(f.path, x'21') IN (0, length(f.path)) ";
constexpr const char* columns_without_volume =
    "SELECT f.path, f.size_bytes, f.state, f.reason, f.registered_ms, NULL, NULL, NULL, NULL, 0, "
    "0, 0, 0, f.modified_ns, f.content_hash, 0 FROM file f ";

}  // namespace

StationSummary StationDatabase::summary() {
    SQLite::Statement row(database_,
                          "SELECT (SELECT count(*) FROM volume), (SELECT count(*) FROM file WHERE "
                          "state = 'rejected'), (SELECT min(start_ms) FROM volume), "
                          "(SELECT coalesce(max(CASE WHEN start_ms <= ? THEN start_ms END), "
                          "max(start_ms)) FROM volume)");
    row.bind(1, milliseconds(now_utc() + tolerated_future).value());
    row.executeStep();
    return {station_, row.getColumn(0).getInt64(), row.getColumn(1).getInt64(),
            optional_time(row.getColumn(2)), optional_time(row.getColumn(3))};
}

std::vector<CatalogEntry> StationDatabase::entries(SQLite::Statement& rows) const {
    std::vector<CatalogEntry> found;
    while (rows.executeStep()) {
        CatalogEntry entry;
        entry.station = station_;
        entry.path = rows.getColumn(0).getString();
        entry.size_bytes = static_cast<std::uint64_t>(rows.getColumn(1).getInt64());
        entry.state = file_state_from_name(rows.getColumn(2).getString()).value_or(FileState::seen);
        entry.reason = rows.getColumn(3).getString();
        entry.registered_time = time_of(rows.getColumn(4).getInt64());
        entry.volume.start_time = optional_time(rows.getColumn(5));
        entry.volume.end_time = optional_time(rows.getColumn(6));
        entry.volume.volume_number = optional_int(rows.getColumn(7));
        entry.volume.vcp = optional_int(rows.getColumn(8));
        entry.volume.sweep_count = rows.getColumn(9).getInt();
        entry.volume.radial_count = rows.getColumn(10).getInt();
        entry.volume.complete = rows.getColumn(11).getInt() != 0;
        entry.generation = rows.getColumn(12).getInt();
        entry.modified_ns = rows.getColumn(13).getInt64();
        entry.content_hash = static_cast<std::uint64_t>(rows.getColumn(14).getInt64());
        entry.number_in_file = rows.getColumn(15).getInt() + 1;
        found.push_back(std::move(entry));
    }
    return found;
}

std::optional<CatalogEntry> StationDatabase::find_file(const fs::path& path) {
    SQLite::Statement row(database_, std::string{columns_without_volume} + "WHERE f.path = ?");
    bind_path(row, 1, path);
    std::vector<CatalogEntry> found = entries(row);
    if (found.empty()) return std::nullopt;
    return std::move(found.front());
}

std::vector<CatalogEntry> StationDatabase::list(const Query& query) {
    static const auto text = [](const char* order) {
        return std::string{entry_columns} + entry_join + "WHERE v.start_ms BETWEEN ? AND ? " +
               order + " LIMIT ?";
    };
    static const std::string ascending =
        text("ORDER BY v.start_ms, v.number, v.generation, f.path");
    static const std::string descending =
        text("ORDER BY v.start_ms DESC, v.number DESC, v.generation DESC, f.path DESC");
    LentStatement rows = prepared((query.newest ? descending : ascending).c_str());
    rows->bind(1, milliseconds(query.from).value_or(std::numeric_limits<std::int64_t>::min()));
    rows->bind(2, milliseconds(query.to).value_or(std::numeric_limits<std::int64_t>::max()));
    constexpr std::int64_t no_limit = -1;
    const std::size_t most = std::min(query.newest.value_or(0), most_listed);
    rows->bind(3, query.newest ? static_cast<std::int64_t>(most) : no_limit);
    std::vector<CatalogEntry> found = entries(*rows);
    if (query.newest) std::ranges::reverse(found);
    if (query.with_rejected) {
        SQLite::Statement others(
            database_, std::string{columns_without_volume} +
                           "WHERE NOT EXISTS (SELECT 1 FROM part p WHERE p.file_id = f.id) "
                           "ORDER BY f.registered_ms, f.path");
        for (CatalogEntry& entry : entries(others))
            found.push_back(std::move(entry));
    }
    return found;
}

std::optional<CatalogEntry> StationDatabase::first(bool latest) {
    static const auto text = [](const char* order) {
        return std::string{entry_columns} + entry_join + "WHERE v.start_ms <= ? " + order +
               " LIMIT 1";
    };
    static const std::string ascending = text("ORDER BY v.start_ms, v.generation, f.path");
    static const std::string descending =
        text("ORDER BY v.start_ms DESC, v.generation DESC, f.path DESC");
    // A volume from the future is the latest one only if all volumes are from the future.
    for (const UtcTime until : {now_utc() + tolerated_future, UtcTime::max()}) {
        LentStatement rows = prepared((latest ? descending : ascending).c_str());
        rows->bind(1, milliseconds(until).value());
        std::vector<CatalogEntry> found = entries(*rows);
        if (!found.empty()) return std::move(found.front());
    }
    return std::nullopt;
}

std::vector<CatalogEntry> StationDatabase::list_stretch(const Stretch& stretch) {
    static const auto text = [](const char* order) {
        return std::string{entry_columns} + entry_join +
               "WHERE v.start_ms BETWEEN ? AND ? AND (? OR p.ordinal = 0) "
               "AND (? OR f.state <> 'gone') AND (? OR " +
               is_no_member + ") ORDER BY v.start_ms " + order + " LIMIT ?";
    };
    static const std::string ascending = text(""), descending = text("DESC");
    LentStatement rows = prepared((stretch.newest_first ? descending : ascending).c_str());
    rows->bind(1, milliseconds(stretch.from).value_or(std::numeric_limits<std::int64_t>::min()));
    rows->bind(2, milliseconds(stretch.to).value_or(std::numeric_limits<std::int64_t>::max()));
    rows->bind(3, stretch.with_later ? 1 : 0);
    rows->bind(4, stretch.with_gone ? 1 : 0);
    rows->bind(5, stretch.with_members ? 1 : 0);
    rows->bind(6, static_cast<std::int64_t>(std::min<std::size_t>(stretch.most, most_listed)));
    return entries(*rows);
}

std::optional<UtcTime> StationDatabase::oldest_kept() {
    constexpr std::int64_t most_tried = 500;
    static const std::string counts = "f.state <> 'gone' AND " + std::string{is_no_member};
    static const std::string of_oldest =
        "SELECT " + counts + ", v.start_ms " + entry_join + "ORDER BY v.start_ms LIMIT ?";
    {
        LentStatement oldest = prepared(of_oldest.c_str());
        oldest->bind(1, most_tried);
        std::int64_t tried = 0;
        for (; oldest->executeStep(); ++tried) {
            if (oldest->getColumn(0).getInt() != 0) return time_of(oldest->getColumn(1).getInt64());
        }
        if (tried < most_tried) return std::nullopt;
    }
    // Most files were deleted, so read the table of files and look up the volumes of the few that
    // are left.
    static const std::string of_all =
        "SELECT min(v.start_ms) FROM file f CROSS JOIN part p ON p.file_id = f.id "
        "CROSS JOIN volume v ON v.id = p.volume_id WHERE " +
        counts;
    LentStatement kept = prepared(of_all.c_str());
    kept->executeStep();
    return optional_time(kept->getColumn(0));
}

std::vector<CatalogEntry> StationDatabase::files_with_prefix(std::string_view prefix,
                                                             std::size_t most) {
    static const std::string text = std::string{columns_without_volume} +
                                    "WHERE f.path >= ? AND f.path < ? ORDER BY f.path LIMIT ?";
    // All paths that callers look for are less than `behind`: a digit follows the prefix of a
    // chunk, and the name of an archive's member in UTF-8 has no byte 0xFF. Only a member whose
    // name begins with this byte, and so is not UTF-8, is not found.
    const std::string behind = std::string{prefix} + '\xFF';
    LentStatement rows = prepared(text.c_str());
    rows->bind(1, prefix.data(), static_cast<int>(prefix.size()));
    rows->bind(2, behind.data(), static_cast<int>(behind.size()));
    rows->bind(3, static_cast<std::int64_t>(std::min<std::size_t>(most, most_listed)));
    return entries(*rows);
}

}  // namespace stormcellar::catalog
