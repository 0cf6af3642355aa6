// stormcellar/catalog/catalog.h -- the catalog: one SQLite database for each station.
//
// DIRECTORY/KTLX.sqlite (WAL, user_version migrations) records which raw files exist, which volumes
// they hold, and the results of ingesting the files. The rows of existing files can always be made
// again from the files. Files of unknown stations are recorded in _unknown.sqlite. Each path has
// one row; registering the same facts again changes nothing. If a volume comes again in a file with
// different contents, it is recorded again, with the next generation number.
//
// A catalog is opened in one of two roles. A CatalogReader answers questions and never creates or
// changes anything. A CatalogWriter answers the same questions, and registers files.
//
// Tables    file (one row for each raw file), volume (station, start, number, generation), part
//           (which file holds which volume).
// Damage    A writer that finds a damaged database sets it aside and continues with a new one,
//           which has the rows of files that are gone (repair.h). take_repairs() reports the
//           repair, and its caller must then register the existing files again. If a database was
//           deleted while it was open, a new one is made, and take_repairs() reports this, too.
// Stations  A rule tells a writer which stations are known. Only known stations have databases;
//           files of all other stations are recorded among the files of unknown stations. Databases
//           of other stations, which an attack or an older configuration left, are neither opened
//           nor changed.
// Bounds    The number of open databases is limited. So are the bytes of the rows in each database,
//           and in all databases together.
// Threads   Many threads may use one catalog (each database has a mutex). Many processes may read
//           while one writes.
// Errors    io, no_space, permission, busy (with SQLite's reason), corrupt (damaged; from a writer
//           only if it could not be repaired), unsupported (a database of a later version or of
//           another program), not_a_file (a FIFO or directory in its place), not_found. A database
//           that cannot be opened affects only its own station: requests for other stations, or for
//           all, continue without it, and troubles() names it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <set>
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
    complete,  // decoded, nothing is missing
    partial,   // decoded in part; the reason says why
    rejected,  // not decodable; the reason says why
    gone,      // the raw file was deleted by its owner
};
[[nodiscard]] std::string_view file_state_name(FileState state);
[[nodiscard]] std::optional<FileState> file_state_from_name(std::string_view name);

// Prefix of the reason in the row of an archive.
inline constexpr std::string_view reason_of_archive = "an archive: ";
// The modification time in the row of a file that could not be read. Such a file is never settled,
// so it is tried again when it is next offered.
inline constexpr std::int64_t never_read_ns = std::numeric_limits<std::int64_t>::min();

// The limit of the volumes in one file, which keeps a forged file from filling the database. Real
// files hold a handful.
inline constexpr std::size_t most_volumes_a_file = 1000;

// A volume in a file.
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
    std::int64_t modified_ns = 0;  // since the epoch; never_read_ns: the contents are unknown
    std::uint64_t content_hash = 0;
    FileState state = FileState::seen;
    std::string reason;  // of the state `rejected` or `partial`, or a remark; one line
    // In the order of the file. Only the first most_volumes_a_file get rows, if they have a start.
    std::vector<VolumeFacts> volumes;
};

// A result of a query: a volume in a file, or a file without volumes.
struct CatalogEntry {
    std::string station;
    std::filesystem::path path;
    std::uint64_t size_bytes = 0;
    FileState state = FileState::seen;
    std::string reason;
    VolumeFacts volume;
    int number_in_file = 1;   // of the volume, from 1
    int generation = 0;       // 0 at first; one more each time the volume comes with new contents
    UtcTime registered_time;  // when the path got its row
    std::int64_t modified_ns = 0;
    std::uint64_t content_hash = 0;  // 0: unknown
};

struct Query {
    std::optional<UtcTime> from;  // inclusive, on the volume's start time
    std::optional<UtcTime> to;    // inclusive
    bool with_rejected = false;   // append all files without a volume, of any time
    // Only this many of the newest volumes; the index makes this fast. None: all.
    std::optional<std::size_t> newest = std::nullopt;
};

// A range of a station's volumes. At most `most` of them are returned.
struct Stretch {
    std::optional<UtcTime> from = std::nullopt;  // inclusive, on the volume's start time
    std::optional<UtcTime> to = std::nullopt;    // inclusive
    std::size_t most = 1000;
    bool newest_first = false;
    bool with_gone = false;    // also files that their owner deleted
    bool with_members = true;  // also members of archives
    bool with_later = false;   // also the second and later volumes of a file
};

struct StationSummary {
    std::string station;
    std::int64_t volume_count = 0;
    std::int64_t rejected_count = 0;
    std::optional<UtcTime> oldest, latest;
};

// The result of registering. left_out: no row was written, because the database has reached its
// limit of bytes, and deleting rows of files that are gone did not make room.
enum class Registered { added, updated, unchanged, left_out };

struct CatalogOptions {
    static constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
    static constexpr std::size_t most_open_of_reader = 32;

    // The stations that have a database; null: every ICAO.
    std::shared_ptr<StationRule> stations;
    // The limit of open databases; each takes three descriptors.
    std::size_t most_open = 256;
    // The canonical path of the drop directory. It is recorded for programs that read the files
    // later (stormcellar/catalog/read_cataloged.h). Empty: the recorded path stays.
    std::filesystem::path drop;
    // Limits of the bytes of rows: for files of unknown stations, for one station, and for all
    // files.
    std::uint64_t most_unknown_bytes = std::uint64_t{64} << 20;
    std::uint64_t most_station_bytes = std::uint64_t{1} << 30;
    std::uint64_t most_bytes = no_limit;
};

// A problem with the database of a station or, if `station` is empty, with the database of unknown
// stations.
struct Trouble {
    std::string station;
    Error error;
};

// Databases of stations that the rule does not know.
struct LeftAlone {
    std::size_t count = 0;
    std::vector<std::string> some;  // the first few names
};

struct Rolled {
    std::int64_t rows = 0;         // deleted
    std::uint64_t used_bytes = 0;  // by the rows of all databases, after deleting
};

// If the rule is `any`, admits stations that have a database in the directory, as
// CatalogWriter::open() does.
Status admit_existing(const std::filesystem::path& directory, StationRule& rule);

class CatalogReader {
  public:
    // Opens a catalog. Errors: not_found if the directory does not exist.
    static Result<CatalogReader> open(std::filesystem::path directory,
                                      std::size_t most_open = CatalogOptions::most_open_of_reader);
    CatalogReader(CatalogReader&&) noexcept;
    CatalogReader& operator=(CatalogReader&&) noexcept;
    CatalogReader(const CatalogReader&) = delete;
    CatalogReader& operator=(const CatalogReader&) = delete;
    ~CatalogReader();

    // Returns true if the catalog has the path with this size and modification time, decoded to its
    // end (complete, partial or rejected), so that nothing is left to do.
    [[nodiscard]] Result<bool> is_settled(const std::filesystem::path& path,
                                          std::uint64_t size_bytes, std::int64_t modified_ns) const;
    // Returns true if the catalog has the path, in any state.
    [[nodiscard]] Result<bool> is_known(const std::filesystem::path& path) const;

    // Returns the known stations that have a database, sorted; an empty text for the database of
    // unknown stations comes first.
    [[nodiscard]] Result<std::vector<std::string>> station_names() const;
    // Returns the databases that could not be used when they were last accessed, with the errors,
    // sorted by station.
    [[nodiscard]] std::vector<Trouble> troubles() const;
    // Returns the directory into which raw files are dropped, as the writer recorded it. Errors:
    // not_found if no writer has recorded a directory.
    [[nodiscard]] Result<std::filesystem::path> drop_directory() const;
    // Returns the number of databases that are open.
    [[nodiscard]] std::size_t open_databases() const;

    // Returns a summary of each station whose database can be read.
    [[nodiscard]] Result<std::vector<StationSummary>> stations() const;
    // Returns the station's volumes in any state, by start, number, generation and path.
    [[nodiscard]] Result<std::vector<CatalogEntry>> list(std::string_view station,
                                                         const Query& query) const;
    // Return the entry with the latest or oldest start; none if the station has no volume. An entry
    // in the future (by is_believed()) is the latest only if all entries are in the future.
    [[nodiscard]] Result<std::optional<CatalogEntry>> latest(std::string_view station) const;
    [[nodiscard]] Result<std::optional<CatalogEntry>> oldest(std::string_view station) const;
    // Returns the row of a file in the station's database, without a volume; none if it has no row.
    [[nodiscard]] Result<std::optional<CatalogEntry>> find_file(
        std::string_view station, const std::filesystem::path& path) const;
    // Returns volumes by start time. Uses the index and stops at `most`, so the time of a call
    // depends only on the entries that it returns or skips, not on all entries of the station.
    [[nodiscard]] Result<std::vector<CatalogEntry>> list_stretch(std::string_view station,
                                                                 const Stretch& stretch) const;
    // Returns the start of the oldest volume in a file that is neither gone nor a member of an
    // archive; none if no volume is in such a file. If none of the oldest 500 volumes is in such a
    // file, reads the whole table of files, which takes 30 ms for 100,000 files.
    [[nodiscard]] Result<std::optional<UtcTime>> oldest_kept(std::string_view station) const;
    // Returns the rows of at most `most` files whose paths begin with `prefix`, in any state and
    // without volumes, by path. Uses the index.
    [[nodiscard]] Result<std::vector<CatalogEntry>> files_with_prefix(std::string_view station,
                                                                      std::string_view prefix,
                                                                      std::size_t most) const;
    [[nodiscard]] const std::filesystem::path& directory() const;

    [[deprecated("CatalogReader::open")]] static Result<CatalogReader> open_for_reading(
        std::filesystem::path directory) {
        return open(std::move(directory));
    }

  protected:
    struct Impl;
    explicit CatalogReader(std::unique_ptr<Impl> impl);
    // Returns the state of the databases, which locks itself.
    [[nodiscard]] Impl& impl() const { return *impl_; }

  private:
    // Returns the result of is_settled(), or none if the path has no row.
    [[nodiscard]] Result<std::optional<bool>> find_settled(const std::filesystem::path& path,
                                                           std::uint64_t size_bytes,
                                                           std::int64_t modified_ns) const;
    template <class Work>
    auto ask(std::string_view station, Work work) const;
    std::unique_ptr<Impl> impl_;
};

// The old name of CatalogReader. The next release removes this name. Programs that write use the
// name of their role.
using Catalog [[deprecated("CatalogReader or CatalogWriter")]] = CatalogReader;

class CatalogWriter : public CatalogReader {
  public:
    // Opens a catalog, and creates the directory if it is missing. If the rule is `any`, admits the
    // stations that have a database already, up to the rule's limit, the most recently written
    // databases first.
    static Result<CatalogWriter> open(std::filesystem::path directory, CatalogOptions options = {});

    // Registers a file. On success a power cut does not undo it, except for the state `seen`, which
    // may be lost.
    Result<Registered> register_file(const FileFacts& facts);
    // Registers a file as `facts` describe it, unless it has a row. Call it after is_known() has
    // returned false.
    Status note_file(const FileFacts& facts);
    // Registers several files of one station like register_file(), in one transaction. Files whose
    // rows find no room are left out.
    Status register_files(const std::string& station, const std::vector<FileFacts>& files);
    // Marks the rows of a raw file that no longer exists as gone. Returns how many were marked.
    Result<int> mark_gone(const std::filesystem::path& path);

    // Marks the rows of all missing files below the directory as gone. Such files vanished while
    // no watcher ran, or are now behind a symbolic link. `step` is called after each station and
    // every 1,000 files, so that the caller can see progress.
    Result<int> mark_missing(const std::filesystem::path& directory,
                             const std::function<void()>& step = {});

    // Marks the rows of a former archive's members as gone, except `members`, because another
    // archive now has the path. Returns how many were marked.
    Result<int> mark_former_members(const std::filesystem::path& archive,
                                    const std::set<std::filesystem::path>& members);

    // Deletes the rows of files that are gone and got their rows before `before`, and the volumes
    // that no other file holds. Returns the number of files. A power cut may bring some rows back.
    // `step` is called after each station and every 1,000 rows.
    Result<int> forget_gone(UtcTime before, const std::function<void()>& step = {});

    // Deletes rows of files that are gone, the oldest first, if rows exceed their limits. First
    // shrinks each database beyond its own limit. Then, while the total exceeds its limit, shrinks
    // the largest database, unless this database is within an equal share of the total. Never
    // deletes rows of existing files. Call it now and then, like forget_gone().
    Result<Rolled> roll(const std::function<void()>& step = {});

    // Returns the databases of stations that the rule does not know; they are not opened.
    [[nodiscard]] Result<LeftAlone> left_alone() const;
    // Reads the whole database of a station (empty: of unknown stations), and repairs it if it is
    // damaged. Does nothing without a database. Errors: those of a database that cannot be read or
    // repaired.
    Status examine(std::string_view station);
    // Calls examine() for all stations, even after an error, and returns the last error.
    Status examine_all();
    // Returns the repairs since the last call. If there are any, also calls read_archives_again().
    std::vector<Repair> take_repairs();
    // Marks settled archives as changed, so that they are read again, because rows of their members
    // may be lost.
    void read_archives_again();

  private:
    explicit CatalogWriter(std::unique_ptr<Impl> impl);
    Result<int> mark_missing_of(const std::string& name, const std::filesystem::path& directory,
                                const std::vector<std::filesystem::path>& paths);
    Status forget_elsewhere(const std::filesystem::path& path, const std::string& name);
};

}  // namespace stormcellar::catalog
