// catalog/catalog.h -- the shadow directories: one SQLite database a station.
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
// catalog then offers it the files again. The same when a database was deleted under it. Errors:
// io, no_space, permission (SQLite's reason), corrupt (damaged; of a writer only where it could not
// be mended), unsupported (a later version's or another program's database), not_found. What
// concerns one station is not held up by the database of another. Thread contract: a Catalog may be
// used by many threads (a mutex a database inside); many processes may read while one writes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "base/utc_time.h"
#include "catalog/repair.h"

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
    std::vector<VolumeFacts> volumes;  // file order
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

// What registering did.
enum class Registered { added, updated, unchanged };

class Catalog {
  public:
    // Creates the directory when it is missing.
    static Result<Catalog> open_for_writing(std::filesystem::path directory);
    // Never creates or changes anything; not_found when the directory does not exist.
    static Result<Catalog> open_for_reading(std::filesystem::path directory);
    Catalog(Catalog&&) noexcept;
    Catalog& operator=(Catalog&&) noexcept;
    Catalog(const Catalog&) = delete;
    Catalog& operator=(const Catalog&) = delete;
    ~Catalog();

    // On success a power cut does not undo it, but for a state of `seen`, which may be lost.
    Result<Registered> register_file(const FileFacts& facts);
    // A file of which is_known() said that it has no row, as seen; what somebody else has written
    // of it meanwhile stays.
    Status note_file(const FileFacts& facts);
    // The same as register_file() of several files of one station, all of them or none.
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

    // True when the path stands in the catalog with this size and modification time and was decoded
    // to its end (complete, partial or rejected): nothing to do again.
    Result<bool> is_settled(const std::filesystem::path& path, std::uint64_t size_bytes,
                            std::int64_t modified_ns);

    // True when the path stands in the catalog, in any state.
    Result<bool> is_known(const std::filesystem::path& path);

    // The stations that have a database, sorted; "" for files without one comes first.
    [[nodiscard]] Result<std::vector<std::string>> station_names() const;
    // Reads the whole database of a station ("": of files without one), and mends it where it is
    // damaged. For a writer. Errors: those of a database that cannot be looked at or mended.
    Status examine(std::string_view station);
    // The same of every station's. The last error, after all were looked at.
    Status examine_all();
    // What was mended since the last call.
    std::vector<Repair> take_repairs();

    Result<std::vector<StationSummary>> stations();
    Result<std::vector<CatalogEntry>> list(std::string_view station, const Query& query);
    // The entry with the latest or oldest start; none when the station has no volume.
    Result<std::optional<CatalogEntry>> latest(std::string_view station);
    Result<std::optional<CatalogEntry>> oldest(std::string_view station);
    [[nodiscard]] const std::filesystem::path& directory() const;

  private:
    struct Impl;
    // Whether the row of the path is settled; none where it has no row.
    Result<std::optional<bool>> find_settled(const std::filesystem::path& path,
                                             std::uint64_t size_bytes, std::int64_t modified_ns);
    Status forget_elsewhere(const std::filesystem::path& path, const std::string& name);
    explicit Catalog(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::catalog
