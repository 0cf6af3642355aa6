// web/data/raw/raw_files.h -- the raw volumes that can be given away, by station and time.
//
// Names are those of the public bucket, STATION, start and version, as in KTLX20220317_000842_V06,
// whatever the file is called that was dropped (web/data/raw/raw_name.h). open() also finds a
// volume by the name of its file. A volume that came as chunks is one file: all chunks, in the
// order of their numbers. Of several files of one name the best counts: one that exists, that was
// decoded, that is complete, that was sent last.
//
// Volumes inside tar and zip archives are left out, because reading one means unpacking all that
// stands before it.
//
// A file is given only if it is still the one that was cataloged: it is opened beneath the drop
// directory without following a link, and its size and hash are those of its row. The hash is
// computed once for each state of a file, since the kernel tells when the file changes (ctime).
//
// Threads   Many threads may use one object.
// Errors    Those of CatalogReader; open() says in its own terms what is missing.
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
    std::string name, state;  // empty: not known
    bool has_place = false;   // the rest is known
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
};

// `grids` place a station that no table has; null: they do not.
[[nodiscard]] RawStation raw_station(std::string_view icao, Grids* grids);

struct RawVolume {
    std::string station;
    std::string name;
    UtcTime start{};
    bool grows = false;        // more will come; size and tag are those of now
    bool is_complete = false;  // decoded, and nothing is missing
    // The following are set by open(), and by list() if RawRange::with_sizes is set.
    std::uint64_t size_bytes = 0;
    UtcTime modified{};
    std::string
        tag;  // an ETag with its quotes; it has a '-', so that no client takes it for an MD5
};

// Returns the name of a volume, whose start must be known.
[[nodiscard]] std::string name_of_entry(const catalog::CatalogEntry& entry);
// Returns the name under which a volume is given away: that of its file if it is found by it. None
// if its file is gone or a member of an archive.
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
    gone,     // its file was there and is deleted
    changed,  // its file is not the one that was cataloged; it may be cataloged again soon
    trouble,  // it could not be read now
};
struct RawFailure {
    RawMissing why = RawMissing::unknown;
    std::string reason;  // for the log; it names paths, so it is not for clients
};
using OpenedOrMissing = tl::expected<OpenedVolume, RawFailure>;

struct RawFilesOptions {
    std::filesystem::path catalog;
    // The same, if it is open already.
    std::shared_ptr<const catalog::CatalogReader> reader = nullptr;
    // Place stations that no table has. Null: they have no place.
    std::shared_ptr<Grids> grids = nullptr;
    // Joined chunks stand here, in files without a name. Empty: the system's temporary directory.
    std::filesystem::path scratch;
    std::size_t most_joined = 16;  // joined volumes kept; each has at most 1 GiB, usually 10 MB
    std::uint64_t most_joined_bytes = std::uint64_t{256} << 20;  // of those
    std::size_t most_open = 64;        // descriptors of volumes kept open, for two seconds
    std::size_t most_databases = 256;  // of the catalog, each with three descriptors
};

class RawFiles {
  public:
    // A catalog that does not exist (yet) has no volumes; that is no error.
    static std::shared_ptr<RawFiles> open_catalog(RawFilesOptions options);
    virtual ~RawFiles() = default;

    // Sorted by ICAO.
    [[nodiscard]] virtual Result<std::vector<RawStation>> stations() = 0;
    // Returns each name once. A station without volumes gives an empty list. Volumes whose file
    // is gone are left out; files that came in the last 30 s and are older than all others may be,
    // too.
    [[nodiscard]] virtual Result<std::vector<RawVolume>> list(std::string_view station,
                                                              const RawRange& range) = 0;
    // Opens a volume. It may compute the hash of a file.
    [[nodiscard]] virtual OpenedOrMissing open(std::string_view station, std::string_view name) = 0;
    // Returns a volume that was opened in the last two seconds and did not change; takes
    // microseconds.
    [[nodiscard]] virtual std::optional<OpenedVolume> open_kept(std::string_view station,
                                                                std::string_view name) = 0;

    // Returns the volume whose start is nearest; none if none is within that time of it.
    [[nodiscard]] Result<std::optional<RawVolume>> nearest(std::string_view station, UtcTime time,
                                                           std::chrono::milliseconds within);
    // Returns the newest volume, but no volume from the future.
    [[nodiscard]] Result<std::optional<RawVolume>> latest(std::string_view station);
};

}  // namespace stormcellar::web
