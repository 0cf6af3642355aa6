// pipeline/options/ingest_options.h -- how files are ingested (pipeline/ingest/ingest.h).
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

namespace stormcellar::pipeline {

// Limit of the packed sweeps of growing volumes on disk, which keep memory small. It applies to
// followed files together with the sites' last volumes, and again to chunks. A feed of 160 sites
// takes 1 to 3 GB for each.
inline constexpr std::uint64_t most_shelf_bytes = std::uint64_t{4} << 30;

// Limit of the unpacked bytes of a file, or of the chunks of a volume: three times a large volume.
inline constexpr std::uint64_t most_unpacked_bytes = std::uint64_t{256} << 20;

// Returns the limit of the arrays of a volume of which these moments are decoded: twice that of any
// known volume, whose largest moment has 14 MiB.
[[nodiscard]] inline std::uint64_t most_array_bytes(const level2::Selection& selection) {
    const std::uint64_t moments =
        selection.moments.empty() ? std::size(level2::all_moments) : selection.moments.size();
    return (16 + 28 * moments) << 20;
}

// Options for gridding volumes while they grow: each sweep as it closes, with the last volume's
// sweeps until their successors come.
struct LivingGrids {
    // The directory for sweeps on disk, in files without names. Empty: no living grids are made,
    // and a volume is finished with the chunks that exist.
    std::filesystem::path scratch;
    bool make = true;  // false: no living grids are made, but chunks are still joined
    // Called before each living grid. Returns false while there is more urgent work; the next
    // living grid then shows the sweeps. Not called for a new low sweep. Empty: there is always
    // time.
    std::function<bool()> has_time;
    // for volumes in chunks (stormcellar/level2/live_volume.h)
    std::chrono::seconds chunk_timeout{600};
    std::chrono::seconds chunk_grace{30};
    // Beyond this limit (see above), the volume that has not grown for longest is given up and read
    // again from its files.
    std::uint64_t shelf_bytes = most_shelf_bytes;
    // Limit of the number of files, volumes of chunks, and last volumes of sites, each with a
    // descriptor.
    std::size_t count = 320;
};

// Decides from the size and hash of a file that was read whether it is gridded; the error says why
// not. The threads that ingest call it.
using ReadCheck = std::function<Status(const std::filesystem::path& path, std::uint64_t size_bytes,
                                       std::uint64_t content_hash)>;

struct IngestOptions {
    // The stations whose data are accepted; null: all with a valid name. Data of other stations are
    // cataloged with those of no known station, and neither followed nor gridded.
    std::shared_ptr<StationRule> stations;
    // Moments of each site's own grids; one decoding and one geometry serve all. Not empty.
    std::vector<level2::Moment> moments = {level2::Moment::ref};
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
    // Nothing outside this directory is opened, wherever links lead (base/beneath.h). Empty: files
    // may be anywhere.
    std::filesystem::path beneath;
    // A larger file is rejected unread. No known volume has half this size.
    std::uint64_t most_file_bytes = std::uint64_t{256} << 20;
    // A file that unpacks to more is rejected, too.
    std::uint64_t most_output_bytes = most_unpacked_bytes;
    // The members of an archive are ingested for this long at a time. Then the archive is
    // incomplete, and continues with its next member when it is offered again (has_next_turn).
    // None: all at once.
    std::optional<std::chrono::milliseconds> archive_turn;
    // Called for each file after it was read and before it is used. Its error rejects the file, for
    // example if it is no longer the cataloged one. Empty: every file is accepted.
    ReadCheck check_read;
};

}  // namespace stormcellar::pipeline
