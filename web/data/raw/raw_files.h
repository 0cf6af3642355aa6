// web/data/raw/raw_files.h -- lists and opens the raw volumes that can be served, by station and
// time.
//
// Volumes have the names of the public bucket, STATION, start and version, as in
// KTLX20220317_000842_V06, whatever the name of the dropped file (web/data/raw/raw_name.h). open()
// also finds a volume by the name of its file. A volume that came as chunks is served as one file:
// all chunks, in the order of their numbers. If several files have one name, open() prefers files
// that exist; among these, files that were decoded; then complete files; then the file that was
// sent last.
//
// Volumes inside tar and zip archives are left out, because reading one means unpacking everything
// before it.
//
// A file is served only if it is still the cataloged one: it is opened beneath the drop directory
// without following a link, and its size and hash must be those of its row. A growing file has no
// hash yet; it must not be shorter than its row says. The hash is computed once for each state of a
// file; the kernel's ctime shows when the file changes.
//
// Threads   Many threads may use one object.
// Errors    Those of CatalogReader; open() reports missing volumes as RawFailure.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/catalog/catalog.h"
#include "web/data/grids/grids.h"
#include "web/http/answer.h"

namespace stormcellar::web {

struct RawStation {
    std::string icao;
    std::string name, state;  // empty: unknown
    bool has_place = false;   // the three fields below are known
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
};

// Returns the facts about a station. `grids` give the place of a station that no table has. If
// `grids` is null, such a station has no place.
[[nodiscard]] RawStation raw_station(std::string_view icao, Grids* grids);

struct RawVolume {
    std::string station;
    std::string name;
    UtcTime start{};
    bool grows = false;        // more will come; size and tag are as of now
    bool is_complete = false;  // decoded, and nothing is missing
    // The fields below are set by open(), and by list() if RawRange::with_sizes is set.
    std::uint64_t size_bytes = 0;
    UtcTime modified{};
    // list() leaves the tag of a growing file empty.
    std::string
        tag;  // an ETag with its quotes; it has a '-', so that no client takes it for an MD5
};

// Returns the name of a volume, whose start must be known.
[[nodiscard]] std::string name_of_entry(const catalog::CatalogEntry& entry);
// Returns a name under which the volume is served: its file's name if open() finds the volume by
// that name, else name_of_entry(). None if the start is unknown, or if the file is gone or a member
// of an archive.
[[nodiscard]] std::optional<std::string> given_name(const catalog::CatalogEntry& entry);

struct RawRange {
    std::optional<UtcTime> from, to;  // inclusive, on the volume's start
    std::size_t most = 1000;
    bool newest_first = false;
    bool with_sizes = false;
};

struct OpenedVolume {
    RawVolume volume;
    Pieces bytes;
};

enum class RawMissing {
    unknown,  // there is no such volume, and there was none
    gone,     // its file existed and has been deleted
    changed,  // its file is not the cataloged one; it may be cataloged again soon
    trouble,  // it cannot be read now
};
struct RawFailure {
    RawMissing why = RawMissing::unknown;
    std::string reason;  // for the log; it names paths, so it is not for clients
};
using OpenedOrMissing = tl::expected<OpenedVolume, RawFailure>;

struct RawFilesOptions {
    std::filesystem::path catalog;
    // The same catalog, if it is already open.
    std::shared_ptr<const catalog::CatalogReader> reader = nullptr;
    // Gives the places of stations that no table has. If null, such stations have no place.
    std::shared_ptr<Grids> grids = nullptr;
    // Directory for joined chunks, in nameless files. If empty, the system's temporary directory is
    // used.
    std::filesystem::path scratch;
    std::size_t most_joined = 16;  // joined volumes kept; each has at most 1 GiB, usually 10 MB
    std::uint64_t most_joined_bytes = std::uint64_t{256} << 20;  // of the joined volumes
    std::size_t most_open = 64;        // descriptors of volumes kept open, for two seconds
    std::size_t most_databases = 256;  // of the catalog, each with three descriptors
};

class RawFiles {
  public:
    // A catalog that does not exist (yet) has no volumes and is no error.
    static std::shared_ptr<RawFiles> open_catalog(RawFilesOptions options);
    virtual ~RawFiles() = default;

    // Returns the stations, sorted by ICAO.
    [[nodiscard]] virtual Result<std::vector<RawStation>> stations() = 0;
    // Returns each name once. A station without volumes gives an empty list. Volumes whose file is
    // gone are left out; files that came in the last 30 s and are older than all others may be
    // missing, too.
    [[nodiscard]] virtual Result<std::vector<RawVolume>> list(std::string_view station,
                                                              const RawRange& range) = 0;
    // Opens a volume. It may compute the hash of a file.
    [[nodiscard]] virtual OpenedOrMissing open(std::string_view station, std::string_view name) = 0;
    // Returns a volume that was opened in the last two seconds and has not changed since; never a
    // growing volume or joined chunks. Takes microseconds.
    [[nodiscard]] virtual std::optional<OpenedVolume> open_kept(std::string_view station,
                                                                std::string_view name) = 0;

    // Returns the volume whose start is nearest to `time`; none if it is farther away than
    // `within`.
    [[nodiscard]] Result<std::optional<RawVolume>> nearest(std::string_view station, UtcTime time,
                                                           std::chrono::milliseconds within);
    // Returns the newest volume that is not from the future.
    [[nodiscard]] Result<std::optional<RawVolume>> latest(std::string_view station);
};

}  // namespace stormcellar::web
