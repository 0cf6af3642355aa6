// pipeline/options/ingest_options.h -- options for ingesting files (pipeline/ingest/ingest.h).
//
// Threads   Plain data.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/options/domain.h"
#include "pipeline/options/partial_sources.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/level2/selection.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::pipeline {

// Limit of the packed sweeps of growing volumes on disk. It applies once to followed files together
// with the sites' last volumes, and once to volumes of chunks. For a feed of 160 sites, each of the
// two takes 1 to 3 GB.
inline constexpr std::uint64_t most_shelf_bytes = std::uint64_t{4} << 30;

// Limit of the unpacked bytes of a file, or of the chunks of a volume: three times the size of a
// large volume.
inline constexpr std::uint64_t most_unpacked_bytes = std::uint64_t{256} << 20;

// Returns the limit of a volume's arrays if these moments are decoded (empty: all): twice the
// arrays of any known volume, whose largest moment has 14 MiB.
[[nodiscard]] inline std::uint64_t most_array_bytes(const level2::Selection& selection) {
    const std::uint64_t moments =
        selection.moments.empty() ? std::size(level2::all_moments) : selection.moments.size();
    return (16 + 28 * moments) << 20;
}

// Options for gridding volumes while they grow. A living grid shows the sweeps that have closed,
// and sweeps of the site's last volume in the place of those that have not.
struct LivingGrids {
    // The directory for sweeps on disk, in files without names. Empty: no living grids are made,
    // and a volume is finished with the chunks that exist.
    std::filesystem::path scratch;
    bool make = true;  // false: no living grids are made, but chunks are still joined
    // Called before living grids are made, unless there is a new low sweep. Returns false while
    // there is more urgent work; then the next living grid shows the sweeps. Empty: there is always
    // time.
    std::function<bool()> has_time;
    // Times for volumes of chunks (stormcellar/level2/live_volume.h).
    std::chrono::seconds chunk_timeout{600};
    std::chrono::seconds chunk_grace{30};
    // Limit of sweeps on disk, applied like most_shelf_bytes. Beyond it, growing volumes are given
    // up (pipeline/ingest/growing_set.h) and read again from their files.
    std::uint64_t shelf_bytes = most_shelf_bytes;
    // The same limit for three numbers: of followed files, of volumes of chunks, and of last
    // volumes of sites. Each file or volume holds a descriptor.
    std::size_t count = 320;
};

// Accepts a file by the size and hash of the bytes read, or returns why it must not be gridded. The
// threads that ingest call it.
using ReadCheck = std::function<Status(const std::filesystem::path& path, std::uint64_t size_bytes,
                                       std::uint64_t content_hash)>;

struct IngestOptions {
    // The stations whose data are accepted; null: all with a valid name. Files of other stations
    // are cataloged among the files of unknown stations, and neither followed nor gridded.
    std::shared_ptr<StationRule> stations;
    // Moments of each site's own grids; one decoding and one geometry serve all. Not empty.
    std::vector<level2::Moment> moments = {level2::Moment::ref};
    retrieve::DerivedOptions derived;  // for moments that are derived
    double spacing_m = 1000;
    int nx = 460, ny = 460;
    std::vector<double> levels_m;  // empty: the default 32
    std::vector<Domain> domains;   // mosaics to keep in addition to each site's own grid
    bool own_grids = true;         // false: sites are gridded only for the domains
    FramesWhen frames = FramesWhen::volume_comes;
    // The machines that bring partials of the domains; null: none.
    std::shared_ptr<PartialSources> partial_sources;
    // Threads in total. Files that are ingested at the same time share them; a single file uses
    // all.
    int decode_threads = 1;
    int grid_threads = 1;
    LivingGrids living;
    // No file outside this directory is opened, and no link below it is followed (base/beneath.h).
    // Empty: files may be anywhere.
    std::filesystem::path beneath;
    // A larger file is rejected unread. No known volume has half this size.
    std::uint64_t most_file_bytes = std::uint64_t{256} << 20;
    // A file that unpacks to more than this is also rejected.
    std::uint64_t most_output_bytes = most_unpacked_bytes;
    // The members of an archive are ingested for this long at a time. Then the result is
    // `incomplete` with has_next_turn, and the next call continues with the next member. None: all
    // members at once.
    std::optional<std::chrono::milliseconds> archive_turn;
    // Called for each file after it was read and before it is used. An error rejects the file, for
    // example because it is no longer the cataloged one. Empty: every file is accepted.
    ReadCheck check_read;
};

}  // namespace stormcellar::pipeline
