// This file opens, creates and identifies a station's database; station_database.cpp works on its
// contents.
#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/beneath.h"
#include "catalog/schema.h"
#include "catalog/station_database.h"

namespace stormcellar::catalog {
namespace {

namespace fs = std::filesystem;

// The longest time for which a statement waits for another process's write.
constexpr int busy_timeout_ms = 10'000;
// At this many pages, the write-ahead log is transferred to the database, and the log's file is cut
// to this size. A registration writes some five pages.
constexpr int most_log_pages = 128;
constexpr int most_log_bytes = 512 << 10;
// The KiB of pages that a connection keeps in memory. SQLite's default of 2 MB for each of 200
// stations would exceed all other memory, and the kernel caches the files anyway.
constexpr int most_cached_kib = 128;
// The KiB for a reader's connection, which needs more because readers walk through lists.
constexpr int most_cached_by_reader_kib = 256;

// Returns a URI of the path, with special characters escaped. `query` is empty or begins with '?'.
std::string uri_of(const std::filesystem::path& path, std::string_view query) {
    std::string uri = "file:";
    for (const char c : path.native()) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (byte >= '0' && byte <= '9') || (byte >= 'A' && byte <= 'Z') ||
                           (byte >= 'a' && byte <= 'z') || c == '/' || c == '.' || c == '_' ||
                           c == '-';
        if (plain) {
            uri += c;
        } else {
            uri += fmt::format("%{:02X}", byte);
        }
    }
    return uri + std::string{query};
}

tl::unexpected<Error> open_failure(const fs::path& path, const SQLite::Exception& error) {
    // SQLite does not tell if a file cannot be opened because permission is missing.
    const bool is_unopened = error.getErrorCode() == SQLITE_CANTOPEN;
    if (is_unopened && ::access(path.c_str(), R_OK) != 0 && errno == EACCES) {
        return fail(ErrorCode::permission, "{}: {}", path.native(),
                    std::system_category().message(EACCES));
    }
    return fail(code_of(error), "{}: {}", path.native(), error.what());
}

// Checks that the database and the files beside it are regular or missing. SQLite would wait at a
// FIFO until a program writes to it.
Status check_regular(const fs::path& path) {
    for (const char* ending : {"", "-wal", "-shm", "-journal"}) {
        const fs::path file = path.native() + ending;
        struct stat facts {};
        if (::stat(file.c_str(), &facts) != 0 || S_ISREG(facts.st_mode)) continue;
        return fail(ErrorCode::not_a_file, "{}: is {}", file.native(), kind_of_file(facts.st_mode));
    }
    return {};
}

enum class Contents { none, ours };

// Checks that the database was made by this software, in a known version. A database without tables
// is still being made.
Result<Contents> identify(SQLite::Database& database, const fs::path& path) {
    // Read in one snapshot, because another process may be making the tables.
    const SQLite::Transaction snapshot(database, SQLite::TransactionBehavior::DEFERRED);
    const int version = database.execAndGet("PRAGMA user_version").getInt();
    const int id = database.execAndGet("PRAGMA application_id").getInt();
    const int tables = database.execAndGet("SELECT count(*) FROM sqlite_schema").getInt();
    if (tables == 0) return Contents::none;
    const bool ours = database
                          .execAndGet(
                              "SELECT count(*) = 3 FROM sqlite_schema WHERE type = 'table' "
                              "AND name IN ('file', 'volume', 'part')")
                          .getInt() != 0;
    if (!ours && id != application_id) {
        return fail(ErrorCode::unsupported, "{}: is not a catalog of this software", path.native());
    }
    if (id == application_id && version > schema_version) {
        return fail(ErrorCode::unsupported,
                    "{}: was made by a later version of this software (schema {}; this version "
                    "knows up to {})",
                    path.native(), version, schema_version);
    }
    if (!ours || id != application_id || version != schema_version) {
        return fail(ErrorCode::corrupt, "{}: tables are missing or their numbers are wrong",
                    path.native());
    }
    return Contents::ours;
}

// Switches to WAL. Waits for other processes, which SQLite itself does not do for this statement.
void enter_wal(SQLite::Database& database) {
    const auto limit =
        std::chrono::steady_clock::now() + std::chrono::milliseconds(busy_timeout_ms);
    for (;;) {
        try {
            database.exec("PRAGMA journal_mode = WAL");
            return;
        } catch (const SQLite::Exception& error) {
            const bool busy = error.getErrorCode() == SQLITE_BUSY;
            if (!busy || std::chrono::steady_clock::now() > limit) throw;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    }
}

void migrate(SQLite::Database& database) {
    // Starting a write would wait for other writers, which is unnecessary for an existing database.
    if (database.execAndGet("PRAGMA user_version").getInt() >= schema_version) return;
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    if (database.execAndGet("PRAGMA user_version").getInt() < 1) {
        database.exec(create_version_1);
        database.exec(fmt::format("PRAGMA application_id = {}", application_id));
        database.exec(fmt::format("PRAGMA user_version = {}", schema_version));
    }
    transaction.commit();
}

// Opens the database for reading in one of two ways, because a reader without write permission
// cannot make the index of the WAL. While a writer has the database open, the index exists. If
// there is no WAL, no process writes, and the file alone is complete.
template <class Open>
auto try_to_read(const fs::path& path, Open open) -> decltype(open(std::string{})) {
    if (Status regular = check_regular(path); !regular) return pass_on(regular);
    std::error_code ignored;
    const bool has_wal = fs::exists(fs::path{path.native() + "-wal"}, ignored);
    for (const char* query : {"?mode=ro", "?mode=ro&immutable=1"}) {
        try {
            return open(uri_of(path, query));
        } catch (const SQLite::Exception& error) {
            const bool last = std::string_view{query}.find("immutable") != std::string_view::npos;
            if (last || has_wal || code_of(error) == ErrorCode::corrupt) {
                return open_failure(path, error);
            }
        }
    }
    return fail(ErrorCode::internal, "{}: cannot be opened", path.native());
}

}  // namespace

ErrorCode code_of(const SQLite::Exception& error) {
    switch (error.getErrorCode()) {
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
        case SQLITE_CONSTRAINT:
        case SQLITE_ERROR:
            return ErrorCode::corrupt;
        case SQLITE_FULL:
            return ErrorCode::no_space;
        case SQLITE_READONLY:
        case SQLITE_PERM:
            return ErrorCode::permission;
        case SQLITE_NOMEM:
            return ErrorCode::exhausted;
        case SQLITE_BUSY:
            return ErrorCode::busy;
        default:
            return ErrorCode::io;
    }
}

StationDatabase::StationDatabase(const std::string& uri, int flags, std::string station)
    : database_(uri, flags | SQLite::OPEN_URI, busy_timeout_ms), station_(std::move(station)) {}

Result<std::unique_ptr<StationDatabase>> StationDatabase::open_for_writing(const fs::path& path,
                                                                           std::string station) {
    if (Status regular = check_regular(path); !regular) return pass_on(regular);
    try {
        std::unique_ptr<StationDatabase> opened(new StationDatabase(
            uri_of(path, ""), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, std::move(station)));
        SQLite::Database& database = opened->database_;
        if (const auto contents = identify(database, path); !contents) return pass_on(contents);
        enter_wal(database);
        database.exec("PRAGMA synchronous = FULL");
        // Each open station has its own log, so no log may grow to SQLite's default of 4 MB.
        database.exec(fmt::format("PRAGMA wal_autocheckpoint = {}", most_log_pages));
        database.exec(fmt::format("PRAGMA journal_size_limit = {}", most_log_bytes));
        database.exec(fmt::format("PRAGMA cache_size = -{}", most_cached_kib));
        database.exec("PRAGMA foreign_keys = ON");
        migrate(database);
        return opened;
    } catch (const SQLite::Exception& error) {
        return open_failure(path, error);
    }
}

std::unique_ptr<StationDatabase> StationDatabase::empty_snapshot(const std::string& station) {
    std::unique_ptr<StationDatabase> made(new StationDatabase(
        "file::memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, station));
    made->database_.exec(create_version_1);
    made->is_snapshot_ = true;
    return made;
}

Result<std::unique_ptr<StationDatabase>> StationDatabase::open_for_reading(
    const fs::path& path, const std::string& station) {
    using Opened = Result<std::unique_ptr<StationDatabase>>;
    return try_to_read(path, [&](const std::string& uri) -> Opened {
        std::unique_ptr<StationDatabase> opened(
            new StationDatabase(uri, SQLite::OPEN_READONLY, station));
        const auto contents = identify(opened->database_, path);
        if (!contents) return pass_on(contents);
        if (*contents == Contents::none) return empty_snapshot(station);
        opened->database_.exec(fmt::format("PRAGMA cache_size = -{}", most_cached_by_reader_kib));
        opened->is_snapshot_ = uri.ends_with("immutable=1");
        return opened;
    });
}

Result<std::unique_ptr<SQLite::Database>> StationDatabase::open_connection(const fs::path& path) {
    using Opened = Result<std::unique_ptr<SQLite::Database>>;
    return try_to_read(path, [&](const std::string& uri) -> Opened {
        auto opened = std::make_unique<SQLite::Database>(
            uri, SQLite::OPEN_READONLY | SQLite::OPEN_URI, busy_timeout_ms);
        (void)opened->execAndGet("PRAGMA user_version");  // reads the first page
        return opened;
    });
}

}  // namespace stormcellar::catalog
