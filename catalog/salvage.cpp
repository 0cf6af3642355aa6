#include "catalog/salvage.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include <SQLiteCpp/SQLiteCpp.h>

#include "catalog/station_database.h"

namespace stormcellar::catalog {
namespace {

// The search ends after this many successive numbers without a row. A page holds some 30 file rows.
constexpr std::int64_t longest_gap = 20'000;

constexpr const char* file_columns =
    "SELECT id, path, size_bytes, modified_ns, content_hash, state, reason, registered_ms FROM "
    "file NOT INDEXED ";

struct Row {
    std::int64_t id = 0;
    SalvagedFile file;
};

// Returns none for a row with impossible contents, because a damaged row may still be readable.
std::optional<Row> row_of(SQLite::Statement& rows) {
    Row row;
    FileFacts& facts = row.file.facts;
    row.id = rows.getColumn(0).getInt64();
    facts.path = rows.getColumn(1).getString();
    facts.size_bytes = static_cast<std::uint64_t>(rows.getColumn(2).getInt64());
    facts.modified_ns = rows.getColumn(3).getInt64();
    facts.content_hash = static_cast<std::uint64_t>(rows.getColumn(4).getInt64());
    facts.reason = rows.getColumn(6).getString();
    row.file.registered_time = UtcTime{std::chrono::milliseconds{rows.getColumn(7).getInt64()}};
    const auto state = file_state_from_name(rows.getColumn(5).getString());
    const bool possible = state && facts.path.is_absolute() && rows.getColumn(2).isInteger() &&
                          rows.getColumn(2).getInt64() >= 0 && rows.getColumn(3).isInteger() &&
                          rows.getColumn(4).isInteger() && rows.getColumn(7).isInteger() &&
                          facts.path.native().find('\0') == std::string::npos;
    if (!possible) return std::nullopt;
    facts.state = *state;
    return row;
}

// Collects the rows of one database.
class Reader {
  public:
    explicit Reader(SQLite::Database& database) : database_(database) {}

    Salvage read() {
        scan("ORDER BY id");
        if (failed_) {
            const std::int64_t low = rows_.empty() ? 0 : rows_.rbegin()->id;
            scan("ORDER BY id DESC");
            const auto behind = rows_.upper_bound(Row{low, {}});
            probe(low, behind == rows_.end() ? std::nullopt : std::optional{behind->id});
        }
        Salvage found;
        for (const Row& row : rows_) {
            found.files.push_back(row.file);
            add_volumes(row.id, found.files.back());
        }
        const std::int64_t last = rows_.empty() ? 0 : rows_.rbegin()->id;
        found.unread_files = last - static_cast<std::int64_t>(rows_.size());
        return found;
    }

  private:
    struct ById {
        bool operator()(const Row& a, const Row& b) const { return a.id < b.id; }
    };

    void keep(SQLite::Statement& rows) {
        if (auto row = row_of(rows)) rows_.insert(std::move(*row));
    }

    // Reads rows as far as possible.
    void scan(const std::string& order) {
        try {
            SQLite::Statement rows(database_, file_columns + order);
            while (rows.executeStep())
                keep(rows);
        } catch (const SQLite::Exception&) {
            failed_ = true;
        }
    }

    // Tries each number between `low` and `end`. Without an end, stops after `longest_gap` numbers
    // without a row.
    void probe(std::int64_t low, std::optional<std::int64_t> end) {
        std::int64_t found_at = low;
        for (std::int64_t id = low + 1; end ? id < *end : id <= found_at + longest_gap; ++id) {
            try {
                SQLite::Statement one(database_, std::string{file_columns} + "WHERE id = ?");
                one.bind(1, id);
                if (!one.executeStep()) continue;
                keep(one);
                found_at = id;
            } catch (const SQLite::Exception&) {
                continue;  // on a damaged page
            }
        }
    }

    void add_volumes(std::int64_t file_id, SalvagedFile& file) {
        try {
            SQLite::Statement rows(
                database_,
                "SELECT v.start_ms, v.end_ms, v.number, v.vcp, v.sweep_count, v.radial_count, "
                "v.complete, v.generation FROM part p JOIN volume v ON v.id = p.volume_id "
                "WHERE p.file_id = ? ORDER BY p.ordinal");
            rows.bind(1, file_id);
            while (rows.executeStep())
                add_volume(rows, file);
        } catch (const SQLite::Exception&) {
            return;  // the row of the file at least shows that the file existed
        }
    }

    static void add_volume(SQLite::Statement& row, SalvagedFile& file) {
        const auto number = [&](int column) -> std::optional<int> {
            if (!row.getColumn(column).isInteger()) return std::nullopt;
            return row.getColumn(column).getInt();
        };
        const auto time = [&](int column) -> std::optional<UtcTime> {
            if (!row.getColumn(column).isInteger()) return std::nullopt;
            return UtcTime{std::chrono::milliseconds{row.getColumn(column).getInt64()}};
        };
        SalvagedVolume volume;
        volume.facts = {time(0),
                        time(1),
                        number(2),
                        number(3),
                        number(4).value_or(0),
                        number(5).value_or(0),
                        number(6).value_or(0) != 0};
        volume.generation = number(7).value_or(0);
        const std::optional<int>& of_day = volume.facts.volume_number;
        if (!volume.facts.start_time || (of_day && (*of_day < 0 || *of_day > 999))) return;
        file.volumes.push_back(volume);
    }

    SQLite::Database& database_;
    std::set<Row, ById> rows_;
    bool failed_ = false;
};

}  // namespace

Salvage salvage(const std::filesystem::path& database) {
    auto opened = StationDatabase::open_connection(database);
    if (!opened) return {};
    try {
        // throws if the file is not a database
        (void)(*opened)->execAndGet("SELECT count(*) FROM sqlite_schema");
        return Reader(**opened).read();
    } catch (const SQLite::Exception&) {
        return {};
    }
}

}  // namespace stormcellar::catalog
