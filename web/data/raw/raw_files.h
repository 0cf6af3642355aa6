// web/data/raw/raw_files.h -- lists and opens the raw volumes that can be served, by station and
// time.
//
// Volumes have the names of the public bucket, made of STATION, start and version, as in
// KTLX20220317_000842_V06, whatever the name of the dropped file is (web/data/raw/raw_name.h).
// open() also finds a volume by the name of its file. A volume that came in chunks is served as one
// file, with all chunks in the order of their numbers. If several files have the same name, open()
// prefers files that exist; among these, files that were decoded; then complete files; then the
// file that was sent last.
//
// Volumes in tar and zip archives are left out, because to read one means to unpack everything
// before it.
//
// A file is served only if it is still as it was cataloged. It is opened beneath the drop directory
// without following a link, and its size and hash must be those in its row. A growing file has no
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
    bool has_place = false;   // true: the three fields below are known
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
};

// Returns what is known about a station. If no table has the station's place, `grids` gives it; if
// `grids` is null, the place is unknown.
[[nodiscard]] RawStation raw_station(std::string_view icao, Grids* grids);

struct RawVolume {
    std::string station;
    std::string name;
    UtcTime start{};
    bool grows = false;         // more will come; size and tag are present values
    bool is_complete = false;   // was decoded, and nothing is missing
    std::optional<int> number;  // that the radar gave the volume; usually 1 to 999
    // The fields below are set by open(), and by list() if RawRange::with_sizes is set.
    std::uint64_t size_bytes = 0;
    UtcTime modified{};
    // Empty for a growing file in a list().
    std::string tag;  // an ETag with its quotes; has a '-', so that nobody takes it for an MD5
};

// Returns the name of a volume. Its start must be known.
[[nodiscard]] std::string name_of_entry(const catalog::CatalogEntry& entry);
// Returns a name under which the volume is served: the name of its file if open() finds the volume
// by this name, else name_of_entry(). Returns none if the start is unknown, or if the file is gone
// or is a member of an archive.
[[nodiscard]] std::optional<std::string> given_name(const catalog::CatalogEntry& entry);

struct RawRange {
    std::optional<UtcTime> from, to;  // range of the volume's start, inclusive
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
    changed,  // its file has changed since it was cataloged; may be cataloged again soon
    trouble,  // it cannot be read now
};
struct RawFailure {
    RawMissing why = RawMissing::unknown;
    std::string reason;  // for the log only, because it names paths
};
using OpenedOrMissing = tl::expected<OpenedVolume, RawFailure>;

struct RawFilesOptions {
    std::filesystem::path catalog;
    // A reader of this catalog, if it is already open.
    std::shared_ptr<const catalog::CatalogReader> reader = nullptr;
    // Gives the places of stations that no table has. If null, such stations have no place.
    std::shared_ptr<Grids> grids = nullptr;
    // Directory for joined chunks, which are in nameless files. If empty, the temporary directory
    // of the system.
    std::filesystem::path scratch;
    std::size_t most_joined = 16;  // joined volumes kept; each has at most 1 GiB, usually 10 MB
    // Limit of all joined volumes together.
    std::uint64_t most_joined_bytes = std::uint64_t{256} << 20;
    std::size_t most_open = 64;        // volumes kept open for two seconds; each has a descriptor
    std::size_t most_databases = 256;  // of the catalog, each with three descriptors
};

class RawFiles {
  public:
    // If the catalog does not exist (yet), it has no volumes; that is no error.
    static std::shared_ptr<RawFiles> open_catalog(RawFilesOptions options);
    virtual ~RawFiles() = default;

    // Returns the stations, sorted by ICAO.
    [[nodiscard]] virtual Result<std::vector<RawStation>> stations() = 0;
    // Returns the volumes, each name once. A station without volumes gives an empty list. Leaves
    // out volumes whose file is gone. May also lack files that came in the last 30 s and are older
    // than all other files.
    [[nodiscard]] virtual Result<std::vector<RawVolume>> list(std::string_view station,
                                                              const RawRange& range) = 0;
    // Opens a volume. May have to compute the hash of a file.
    [[nodiscard]] virtual OpenedOrMissing open(std::string_view station, std::string_view name) = 0;
    // Returns a volume that was opened in the last two seconds and has not changed since. Never
    // returns a growing volume or joined chunks. Takes microseconds.
    [[nodiscard]] virtual std::optional<OpenedVolume> open_kept(std::string_view station,
                                                                std::string_view name) = 0;

    // Returns the volume whose start is nearest to `time`. Returns none if that is farther away
    // than `within`.
    [[nodiscard]] Result<std::optional<RawVolume>> nearest(std::string_view station, UtcTime time,
                                                           std::chrono::milliseconds within);
    // Returns the newest volume that is not in the future.
    [[nodiscard]] Result<std::optional<RawVolume>> latest(std::string_view station);
};

}  // namespace stormcellar::web
