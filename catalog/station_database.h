// catalog/station_database.h -- one station's SQLite database. Used only inside the catalog room.
//
// Methods throw SQLite::Exception, which CatalogReader::Impl turns into errors.
//
// Threads   One thread at a time; each database has a mutex (catalog/open_databases.h).
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

// Returns the error code of an SQLite failure. A statement that is invalid or violates a constraint
// means `corrupt`, because all statements of this room succeed on a sound database.
[[nodiscard]] ErrorCode code_of(const SQLite::Exception& error);

// A prepared statement on loan. The destructor resets it, so that it holds no lock and no values.
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
    // Creates the file and its tables if they are missing. Errors: unsupported or corrupt for a
    // database of a later version or of another program.
    static Result<std::unique_ptr<StationDatabase>> open_for_writing(
        const std::filesystem::path& path, std::string station);
    static Result<std::unique_ptr<StationDatabase>> open_for_reading(
        const std::filesystem::path& path, const std::string& station);

    // Opens an existing database for reading only. Nothing is read yet, so most faults are noticed
    // later.
    static Result<std::unique_ptr<SQLite::Database>> open_connection(
        const std::filesystem::path& path);

    // Returns true if this object does not see later writes, because no process had the database
    // open for writing, or its writer had not yet made the tables.
    [[nodiscard]] bool is_snapshot() const { return is_snapshot_; }

    // Sets the limit of used_bytes(). At the limit, a new row is written only if deleting rows of
    // files that are gone makes room.
    void set_most_bytes(std::uint64_t most_bytes) { most_bytes_ = most_bytes; }
    // Returns the bytes that rows and indices take, without free pages.
    std::uint64_t used_bytes();

    Registered register_file(const FileFacts& facts);
    // Registers all files in one transaction. Returns the paths for which there was no room.
    std::vector<std::filesystem::path> register_files(const std::vector<FileFacts>& files);
    // Inserts the rows into a new database in one transaction. Sets their state to `gone`, and
    // changes nothing else in the rows.
    void restore_gone(const std::vector<SalvagedFile>& files);
    // Marks the rows of these files as gone in one transaction. Returns how many rows were marked.
    int mark_gone(const std::vector<std::filesystem::path>& paths);
    // Makes settled archives count as changed from now on.
    void read_archives_again();
    // Reads at most `most` rows that are not gone, with numbers above `after`, and returns their
    // paths that are below the directory. Rows are read in portions because a database may hold
    // more paths than fit into memory.
    struct Paths {
        std::vector<std::filesystem::path> paths;
        std::int64_t last = 0;  // the number of the last row read
        bool are_all = true;    // there are no more rows
    };
    Paths paths_below(const std::filesystem::path& directory, std::int64_t after,
                      std::int64_t most);
    void forget(const std::filesystem::path& path);
    // Returns the numbers of rows that are gone and were made before `before`.
    std::vector<std::int64_t> gone_before(UtcTime before);
    // Deletes the rows in `rows` that are still gone and were made before `before`, in one
    // transaction. Returns how many were deleted.
    int forget_gone(std::span<const std::int64_t> rows, UtcTime before);
    // Deletes the oldest rows of files that are gone, at most `most`, in one transaction. Returns
    // how many were deleted.
    std::int64_t forget_oldest_gone(std::int64_t most);
    // Calls `look` with the paths of all rows, in any state. Returns false, without reading any, if
    // there may be more than `most` rows.
    bool look_at_paths(const std::function<void(std::string_view)>& look, std::int64_t most);
    // Returns true if the path is settled with this size and modification time; none if it has no
    // row.
    std::optional<bool> is_settled(const std::filesystem::path& path, std::uint64_t size_bytes,
                                   std::int64_t modified_ns);

    StationSummary summary();
    std::optional<CatalogEntry> find_file(const std::filesystem::path& path);
    std::vector<CatalogEntry> list(const Query& query);
    std::optional<CatalogEntry> first(bool latest);
    std::vector<CatalogEntry> list_stretch(const Stretch& stretch);
    std::optional<UtcTime> oldest_kept();
    std::vector<CatalogEntry> files_with_prefix(std::string_view prefix, std::size_t most);

  private:
    StationDatabase(const std::string& uri, int flags, std::string station);
    // Returns an empty database, for a reader of a database whose tables do not exist yet.
    static std::unique_ptr<StationDatabase> empty_snapshot(const std::string& station);

    // Returns the prepared statement of `sql`, which must live as long as the program.
    LentStatement prepared(const char* sql);
    void set_durable(bool durable);
    Registered register_row(const FileFacts& facts);
    // Returns true if a new row may be written. Call it inside a transaction.
    bool make_room();
    std::int64_t delete_oldest_gone(std::int64_t most);
    // Returns the id of the file's row, and sets `is_same` if the row already has these facts.
    std::optional<std::int64_t> find_file(const FileFacts& facts, bool& is_same);
    bool has_these_volumes(std::int64_t file_id, const std::vector<VolumeFacts>& volumes);
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
    bool is_durable_ = true;  // applies to the next transaction that may write
    std::uint64_t most_bytes_ = CatalogOptions::no_limit;
    bool may_have_gone_ = true;  // false: no row is marked as gone
};

}  // namespace stormcellar::catalog
