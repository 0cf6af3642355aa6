// catalog/station_database.h -- one station's SQLite database; used by the catalog alone.
//
// Methods throw SQLite::Exception, which the catalog turns into errors. Thread contract: one thread
// at a time; the catalog holds a mutex for each.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "catalog/salvage.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::catalog {

// What an SQLite failure is to a caller. Every statement of ours fits a sound database and breaks
// no constraint of it, so one that does not was met in a damaged one.
[[nodiscard]] ErrorCode code_of(const SQLite::Exception& error);

// A statement that is kept for the next time, lent. Given back it keeps no lock and no values.
class LentStatement {
  public:
    explicit LentStatement(SQLite::Statement& statement) : statement_(statement) {}
    ~LentStatement() {
        (void)statement_.tryReset();
        statement_.clearBindings();
    }
    LentStatement(const LentStatement&) = delete;
    LentStatement& operator=(const LentStatement&) = delete;

    SQLite::Statement& operator*() { return statement_; }
    SQLite::Statement* operator->() { return &statement_; }

  private:
    SQLite::Statement& statement_;
};

class StationDatabase {
  public:
    // Creates the file and its tables when they are missing. unsupported or corrupt for a database
    // of a later version or of another program.
    static Result<std::unique_ptr<StationDatabase>> open_for_writing(
        const std::filesystem::path& path, std::string station);
    static Result<std::unique_ptr<StationDatabase>> open_for_reading(
        const std::filesystem::path& path, const std::string& station);

    // For looking alone, of whatever stands there: nothing is asked of it yet, so most of what is
    // wrong with it comes out later.
    static Result<std::unique_ptr<SQLite::Database>> open_connection(
        const std::filesystem::path& path);

    // Opened as a file that nobody writes: what is written later is not seen by this object.
    [[nodiscard]] bool is_snapshot() const { return is_snapshot_; }

    // From now on a new row is written only while the database takes less, or while rows of files
    // that are gone can make room.
    void set_most_bytes(std::uint64_t most_bytes) { most_bytes_ = most_bytes; }
    // What its rows and indices take, without pages that are free.
    std::uint64_t used_bytes();

    Registered register_file(const FileFacts& facts);
    // All in one transaction; gives the paths of those that found no room.
    std::vector<std::filesystem::path> register_files(const std::vector<FileFacts>& files);
    // Rows of files that are gone, verbatim but for their state; in one transaction. For a new
    // database.
    void restore_gone(const std::vector<SalvagedFile>& files);
    // In one transaction; gives how many rows were marked.
    int mark_gone(const std::vector<std::filesystem::path>& paths);
    // Of the rows that are not gone those with a number above `after`: `most` rows at once, as a
    // database may hold more paths than memory.
    struct Paths {
        std::vector<std::filesystem::path> paths;
        std::int64_t last = 0;  // the number of the last row that was looked at
        bool are_all = true;    // there is none behind it
    };
    Paths paths_below(const std::filesystem::path& directory, std::int64_t after,
                      std::int64_t most);
    void forget(const std::filesystem::path& path);
    // The rows' numbers of files that are gone and were last registered before that time.
    std::vector<std::int64_t> gone_before(UtcTime before);
    // Deletes those of them that still are so, in one transaction; gives how many.
    int forget_gone(std::span<const std::int64_t> rows, UtcTime before);
    // Deletes the oldest of these, in one transaction; gives how many.
    std::int64_t forget_oldest_gone(std::int64_t most);
    // Shows the paths of all rows, in whatever state. False where there may be more than `most`
    // rows, of which none is looked at then.
    bool look_at_paths(const std::function<void(std::string_view)>& look, std::int64_t most);
    // None when the path has no row.
    std::optional<bool> is_settled(const std::filesystem::path& path, std::uint64_t size_bytes,
                                   std::int64_t modified_ns);

    StationSummary summary();
    std::optional<CatalogEntry> find_file(const std::filesystem::path& path);
    std::vector<CatalogEntry> list(const Query& query);
    std::optional<CatalogEntry> first(bool latest);

  private:
    StationDatabase(const std::string& uri, int flags, std::string station);

    // The statement of that text, which has to live as long as the program.
    LentStatement prepared(const char* sql);
    void set_durable(bool durable);
    Registered register_row(const FileFacts& facts);
    // Inside a transaction: whether a new row may be written.
    bool make_room();
    std::int64_t delete_oldest_gone(std::int64_t most);
    // The id of its row; is_same is set where the row says the same already.
    std::optional<std::int64_t> find_file(const FileFacts& facts, bool& is_same);
    std::int64_t write_file(const FileFacts& facts);
    void drop_volumes(std::int64_t file_id);
    std::int64_t restore_volume(const SalvagedVolume& volume);
    std::int64_t insert_volume(const VolumeFacts& facts, int generation);
    void insert_part(std::int64_t file_id, int ordinal, std::int64_t volume_id);
    std::int64_t store_volume(std::int64_t file_id, std::uint64_t content_hash,
                              const VolumeFacts& facts);
    std::vector<CatalogEntry> entries(SQLite::Statement& rows) const;

    SQLite::Database database_;
    std::string station_;
    std::map<const char*, SQLite::Statement> statements_;
    bool is_snapshot_ = false;
    bool is_durable_ = true;  // of the next transaction, where it may write
    std::uint64_t most_bytes_ = CatalogOptions::no_limit;
    bool may_have_gone_ = true;  // rows of files that are gone; false: there are none
};

}  // namespace stormcellar::catalog
