// Deletes rows of files that are gone: rows that are too old, and the oldest rows to make room.
#include <vector>

#include "catalog/station_database.h"

namespace stormcellar::catalog {
namespace {

// The number of rows that are deleted together to make room, so that searches are rare.
constexpr std::int64_t rows_a_batch = 1000;
constexpr int most_batches = 8;

}  // namespace

std::vector<std::int64_t> StationDatabase::gone_before(UtcTime before) {
    SQLite::Statement rows(database_,
                           "SELECT id FROM file WHERE state = 'gone' AND registered_ms < ?");
    rows.bind(1, before.time_since_epoch().count());
    std::vector<std::int64_t> found;
    while (rows.executeStep())
        found.push_back(rows.getColumn(0).getInt64());
    return found;
}

int StationDatabase::forget_gone(std::span<const std::int64_t> rows, UtcTime before) {
    set_durable(false);
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    int forgotten = 0;
    for (const std::int64_t row : rows) {
        LentStatement still =
            prepared("SELECT 1 FROM file WHERE id = ? AND state = 'gone' AND registered_ms < ?");
        still->bind(1, row);
        still->bind(2, before.time_since_epoch().count());
        if (!still->executeStep()) continue;
        drop_volumes(row);
        LentStatement remove = prepared("DELETE FROM file WHERE id = ?");
        remove->bind(1, row);
        forgotten += remove->exec();
    }
    transaction.commit();
    return forgotten;
}

std::uint64_t StationDatabase::used_bytes() {
    const auto ask = [&](const char* pragma) {
        LentStatement row = prepared(pragma);
        row->executeStep();
        return row->getColumn(0).getInt64();
    };
    const std::int64_t pages = ask("PRAGMA page_count") - ask("PRAGMA freelist_count");
    return static_cast<std::uint64_t>(pages * ask("PRAGMA page_size"));
}

bool StationDatabase::make_room() {
    if (most_bytes_ == CatalogOptions::no_limit || used_bytes() < most_bytes_) return true;
    for (int batch = 0; batch < most_batches && may_have_gone_; ++batch) {
        // This object sets the flag again when it marks rows as gone, and no other process marks
        // rows.
        may_have_gone_ = delete_oldest_gone(rows_a_batch) == rows_a_batch;
        if (used_bytes() < most_bytes_) return true;
    }
    return used_bytes() < most_bytes_;
}

std::int64_t StationDatabase::delete_oldest_gone(std::int64_t most) {
    std::vector<std::int64_t> rows;
    {
        // Row numbers ascend in the order in which rows were made.
        SQLite::Statement oldest(database_,
                                 "SELECT id FROM file WHERE state = 'gone' ORDER BY id LIMIT ?");
        oldest.bind(1, most);
        while (oldest.executeStep())
            rows.push_back(oldest.getColumn(0).getInt64());
    }
    for (const std::int64_t row : rows) {
        drop_volumes(row);
        LentStatement remove = prepared("DELETE FROM file WHERE id = ?");
        remove->bind(1, row);
        remove->exec();
    }
    return static_cast<std::int64_t>(rows.size());
}

std::int64_t StationDatabase::forget_oldest_gone(std::int64_t most) {
    set_durable(false);
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    const std::int64_t deleted = delete_oldest_gone(most);
    if (deleted > 0) transaction.commit();
    return deleted;
}

}  // namespace stormcellar::catalog
