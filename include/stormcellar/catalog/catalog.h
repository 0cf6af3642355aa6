// stormcellar/catalog/catalog.h -- the shadow directories: one SQLite database a station.
//
// DIRECTORY/KTLX.sqlite (WAL, user_version migrations) says which raw files exist, which volumes
// they hold, and what became of them. It is an index: it can always be rebuilt from the files.
// Files whose station is unknown go to _unknown.sqlite. Registering is idempotent: the same path
// with the same size, modification time and content is the same row; a re-sent volume that differs
// gets the next generation.
// Tables: file (one row a raw file), volume (station, start, number, generation), part (which file
// holds which volume).
// Damage: a writer that meets a damaged database sets it aside and goes on with a new one, which
// has the rows of files that are gone (repair.h); take_repairs() says so, and whoever feeds the
// catalog then offers it the files again. The same when a database was deleted under it.
// Stations: a writer is told by a rule which stations it knows. Only these have databases; rows of
// all other files stand among those of no known station. Databases of other stations, which an
// attack or an older configuration left, are left alone: a writer does not open them.
// Bounds: of the databases only so many are open at once (catalog/open_databases.h), and each has a
// most that its rows may take.
// Errors: io, no_space, permission, busy (SQLite's reason), corrupt (damaged; of a writer only
// where it could not be mended), unsupported (a later version's or another program's database),
// not_a_file (a FIFO or directory in its place), not_found. A database that cannot be opened is the
// trouble of its own station alone: what concerns another, or all, goes on without it, and
// troubles() names it. A catalog is opened in one of two roles: a CatalogReader answers questions
// and never creates or changes anything; a CatalogWriter answers the same questions, and registers
// files. Thread contract: a catalog may be used by many threads (a mutex a database inside); many
// processes may read while one writes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/catalog/repair.h"

namespace stormcellar::catalog {

enum class FileState {
    seen,      // exists, not yet decoded to its end
    complete,  // decoded, nothing missing
    partial,   // decoded in part; problems say why
    rejected,  // not decodable; reason says why
    gone,      // the raw file was deleted by its owner
};
[[nodiscard]] std::string_view file_state_name(FileState state);
[[nodiscard]] std::optional<FileState> file_state_from_name(std::string_view name);

// The modification time of a file that could not be read: it is never settled, and tried again
// when it is next looked at.
inline constexpr std::int64_t never_read_ns = std::numeric_limits<std::int64_t>::min();

// An archive's file holds a handful; a made-up one must not fill the database by itself.
inline constexpr std::size_t most_volumes_a_file = 1000;

// A volume as a file holds it.
struct VolumeFacts {
    std::optional<UtcTime> start_time;
    std::optional<UtcTime> end_time;
    std::optional<int> volume_number;  // 0-999
    std::optional<int> vcp;
    int sweep_count = 0;
    int radial_count = 0;
    bool complete = false;
};

struct FileFacts {
    std::filesystem::path path;  // absolute
    std::string station;         // ICAO, or empty: unknown
    std::uint64_t size_bytes = 0;
    std::int64_t modified_ns = 0;  // since the epoch; never_read_ns: its contents are unknown
    std::uint64_t content_hash = 0;
    FileState state = FileState::seen;
    std::string reason;                // why rejected or partial; one line
    std::vector<VolumeFacts> volumes;  // file order; the first most_volumes_a_file get rows
};

// A row of the answer to a query: one volume in one file, or a file without volumes.
struct CatalogEntry {
    std::string station;
    std::filesystem::path path;
    std::uint64_t size_bytes = 0;
    FileState state = FileState::seen;
    std::string reason;
    VolumeFacts volume;
    int generation = 0;       // 0 for the first; +1 for each re-send that differs
    UtcTime registered_time;  // when the row was made
    std::int64_t modified_ns = 0;
    std::uint64_t content_hash = 0;  // 0: not known
};

struct Query {
    std::optional<UtcTime> from;  // inclusive, on the volume's start time
    std::optional<UtcTime> to;    // inclusive
    bool with_rejected = false;   // also files that hold no volume
};

struct StationSummary {
    std::string station;
    std::int64_t volume_count = 0;
    std::int64_t rejected_count = 0;
    std::optional<UtcTime> oldest, latest;
};

// What registering did. left_out: no row was written, as the database has reached its bound and no
// row of a file that is gone could make room.
enum class Registered { added, updated, unchanged, left_out };

struct CatalogOptions {
    static constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
    static constexpr std::size_t most_open_of_reader = 32;

    // Which stations have a database; none: every ICAO.
    std::shared_ptr<StationRule> stations;
    // So many databases are open at once; each takes three descriptors.
    std::size_t most_open = 256;
    // The directory that raw files are dropped into, canonical. It is written down for those who
    // read the files later (stormcellar/catalog/read_cataloged.h). Empty: what was written down
    // stays.
    std::filesystem::path drop;
    // What rows may take: of files of no known station, of one station's files, and of all.
    std::uint64_t most_unknown_bytes = std::uint64_t{64} << 20;
    std::uint64_t most_station_bytes = std::uint64_t{1} << 30;
    std::uint64_t most_bytes = no_limit;
};

// What is wrong with the database of a station; empty: with that of files without one.
struct Trouble {
    std::string station;
    Error error;
};

// Databases of stations that are not known.
struct LeftAlone {
    std::size_t count = 0;
    std::vector<std::string> some;  // the first few names
};

struct Rolled {
    std::int64_t rows = 0;         // were deleted
    std::uint64_t used_bytes = 0;  // by the rows of all databases, after it
};

// By the rule `any`, admits the stations that have a database in the directory; see
// CatalogWriter::open().
Status admit_existing(const std::filesystem::path& directory, StationRule& rule);

class CatalogReader {
  public:
    // not_found when the directory does not exist.
    static Result<CatalogReader> open(std::filesystem::path directory);
    CatalogReader(CatalogReader&&) noexcept;
    CatalogReader& operator=(CatalogReader&&) noexcept;
    CatalogReader(const CatalogReader&) = delete;
    CatalogReader& operator=(const CatalogReader&) = delete;
    ~CatalogReader();

    // True when the path stands in the catalog with this size and modification time and was decoded
    // to its end (complete, partial or rejected): nothing to do again.
    [[nodiscard]] Result<bool> is_settled(const std::filesystem::path& path,
                                          std::uint64_t size_bytes, std::int64_t modified_ns) const;
    // True when the path stands in the catalog, in any state.
    [[nodiscard]] Result<bool> is_known(const std::filesystem::path& path) const;

    // The known stations that have a database, sorted; "" for files without one comes first.
    [[nodiscard]] Result<std::vector<std::string>> station_names() const;
    // Which databases could not be used when they were asked last, and why; by station. One is
    // added when its trouble begins, and removed when it can be used again.
    [[nodiscard]] std::vector<Trouble> troubles() const;
    // The directory that raw files are dropped into, as the writer wrote it down; not_found where
    // no writer did.
    [[nodiscard]] Result<std::filesystem::path> drop_directory() const;
    // How many databases are open.
    [[nodiscard]] std::size_t open_databases() const;

    // Of all stations whose databases can be read.
    [[nodiscard]] Result<std::vector<StationSummary>> stations() const;
    [[nodiscard]] Result<std::vector<CatalogEntry>> list(std::string_view station,
                                                         const Query& query) const;
    // The entry with the latest or oldest start; none when the station has no volume. What lies in
    // the future (is_believed()) is the latest only where all does.
    [[nodiscard]] Result<std::optional<CatalogEntry>> latest(std::string_view station) const;
    [[nodiscard]] Result<std::optional<CatalogEntry>> oldest(std::string_view station) const;
    // The row of a file in that station's database, without a volume; none where it has no row.
    [[nodiscard]] Result<std::optional<CatalogEntry>> find_file(
        std::string_view station, const std::filesystem::path& path) const;
    [[nodiscard]] const std::filesystem::path& directory() const;

    [[deprecated("CatalogReader::open")]] static Result<CatalogReader> open_for_reading(
        std::filesystem::path directory) {
        return open(std::move(directory));
    }

  protected:
    struct Impl;
    explicit CatalogReader(std::unique_ptr<Impl> impl);
    // The catalog's memory of its databases. It is shared by threads and locks itself.
    [[nodiscard]] Impl& impl() const { return *impl_; }

  private:
    // Whether the row of the path is settled; none where it has no row.
    [[nodiscard]] Result<std::optional<bool>> find_settled(const std::filesystem::path& path,
                                                           std::uint64_t size_bytes,
                                                           std::int64_t modified_ns) const;
    template <class Work>
    auto ask(std::string_view station, Work work) const;
    std::unique_ptr<Impl> impl_;
};

// The old name, for programs that read; it goes with the next release. Programs that write name
// their role.
using Catalog [[deprecated("CatalogReader or CatalogWriter")]] = CatalogReader;

class CatalogWriter : public CatalogReader {
  public:
    // Creates the directory when it is missing. By the rule `any` the stations that have a database
    // already are admitted, the newest database first, as far as the rule's bound allows.
    static Result<CatalogWriter> open(std::filesystem::path directory, CatalogOptions options = {});

    // On success a power cut does not undo it, but for a state of `seen`, which may be lost.
    Result<Registered> register_file(const FileFacts& facts);
    // A file of which is_known() said that it has no row, as seen; what somebody else has written
    // of it meanwhile stays.
    Status note_file(const FileFacts& facts);
    // The same as register_file() of several files of one station, all of them or none; rows that
    // find no room are left out.
    Status register_files(const std::string& station, const std::vector<FileFacts>& files);
    // Marks rows whose raw file no longer exists as gone; gives how many were marked.
    Result<int> mark_gone(const std::filesystem::path& path);

    // The same for every row below the directory: what went while nobody watched, or lies behind a
    // symbolic link by now. `step` is called after each station and every 1,000 files, for whoever
    // watches that it moves on.
    Result<int> mark_missing(const std::filesystem::path& directory,
                             const std::function<void()>& step = {});

    // Deletes the rows of files that are gone and were last registered before that time, with the
    // volumes that no other file holds; gives how many files'. A power cut may bring some back.
    // `step` is called after each station and every 1,000 rows.
    Result<int> forget_gone(UtcTime before, const std::function<void()>& step = {});

    // Deletes rows of files that are gone, the oldest first, where they take more than they may:
    // first in each database beyond its own bound, then in the largest while all are beyond theirs.
    // Rows of files that are there are never deleted. To be called now and then, as forget_gone().
    Result<Rolled> roll(const std::function<void()>& step = {});

    // The databases of other stations, which stand there and are not opened.
    [[nodiscard]] Result<LeftAlone> left_alone() const;
    // Reads the whole database of a station ("": of files without one), and mends it where it is
    // damaged. Errors: those of a database that cannot be looked at or mended.
    Status examine(std::string_view station);
    // The same of every station's. The last error, after all were looked at.
    Status examine_all();
    // What was mended since the last call.
    std::vector<Repair> take_repairs();

  private:
    explicit CatalogWriter(std::unique_ptr<Impl> impl);
    Result<int> mark_missing_of(const std::string& name, const std::filesystem::path& directory,
                                const std::vector<std::filesystem::path>& paths);
    Status forget_elsewhere(const std::filesystem::path& path, const std::string& name);
};

}  // namespace stormcellar::catalog
