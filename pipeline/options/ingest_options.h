// pipeline/options/ingest_options.h -- options for ingesting files (pipeline/ingest/ingest.h).
//
// Threads   Plain data.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/options/domain.h"
#include "pipeline/options/partial_sources.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/level2/selection.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::pipeline {

// Limit of the disk space for packed sweeps of growing volumes. It applies twice: to followed files
// together with the sites' last volumes, and to volumes in chunks. For a feed of 160 sites, each of
// the two takes 1 to 3 GB.
inline constexpr std::uint64_t most_shelf_bytes = std::uint64_t{4} << 30;

// Limit of the unpacked size of a file, or of all chunks of a volume. It is three times the size of
// a large volume.
inline constexpr std::uint64_t most_unpacked_bytes = std::uint64_t{256} << 20;

// Returns what to decode for grids of these moments, without echo whose probability of weather is
// below `quality`. Some moments, and the judgment of echo, take all measured moments.
[[nodiscard]] inline level2::Selection decoded_for(std::vector<level2::Moment> moments,
                                                   double quality) {
    if (quality > 0 || std::ranges::any_of(moments, level2::uses_all_moments)) return {};
    return {std::move(moments), {}};
}

// Returns the limit of a volume's arrays if these moments are decoded (empty: all). It is twice the
// size of the arrays of any known volume; the largest moment has 14 MiB.
[[nodiscard]] inline std::uint64_t most_array_bytes(const level2::Selection& selection) {
    const std::uint64_t moments =
        selection.moments.empty() ? std::size(level2::all_moments) : selection.moments.size();
    return (16 + 28 * moments) << 20;
}

// The amount of waiting work, which decides what living grids show at once.
enum class Load : std::uint8_t {
    light,  // living grids show every new sweep
    heavy,  // only low sweeps, because users look at them first
    late,   // none: volumes that have ended wait too long for their grids
};

// Options for gridding volumes while they grow. The living grid of a growing volume shows the
// sweeps that are complete. In place of the missing sweeps it shows sweeps of the site's last
// volume.
struct LivingGrids {
    // The directory for sweeps on disk, in files without names. Empty: no living grids are made,
    // and a volume is finished with the chunks that exist.
    std::filesystem::path scratch;
    bool make = true;  // false: no living grids, but chunks are still joined
    // Called before living grids are made. Sweeps that are left out are shown by the next living
    // grid. Empty: the load is always light.
    std::function<Load()> load;
    // Times of waiting for the chunks of a volume (stormcellar/level2/live_volume.h).
    std::chrono::seconds chunk_timeout{600};
    std::chrono::seconds chunk_grace{30};
    // Limit of the disk space for sweeps, applied twice like most_shelf_bytes. Beyond it, growing
    // volumes are given up (pipeline/ingest/growing_set.h) and read again from their files.
    std::uint64_t shelf_bytes = most_shelf_bytes;
    // The limit of three numbers: followed files, volumes in chunks, and last volumes of sites.
    // Each of these holds a descriptor.
    std::size_t count = 320;
};

// Accepts a file by the size and hash of the bytes that were read, or returns the reason why it
// must not be gridded. The threads that ingest call this function.
using ReadCheck = std::function<Status(const std::filesystem::path& path, std::uint64_t size_bytes,
                                       std::uint64_t content_hash)>;

struct IngestOptions {
    // The stations whose data are accepted; null: all that have a valid name. Files of other
    // stations are cataloged among the files of unknown stations. They are neither followed nor
    // gridded.
    std::shared_ptr<StationRule> stations;
    // The moments of each site's own grids. A volume is decoded once for all, with one geometry.
    // Not empty.
    std::vector<level2::Moment> moments = {level2::Moment::ref};
    // Says how to derive moments. Its quality holds for all grids.
    retrieve::DerivedOptions derived;
    double spacing_m = 1000;
    int nx = 460, ny = 460;
    std::vector<double> levels_m;  // empty: the default 32
    std::vector<Domain> domains;   // mosaics to keep in addition to each site's own grid
    bool own_grids = true;         // false: make only partials for the domains
    FramesWhen frames = FramesWhen::volume_comes;
    // The machines that bring partials of the domains; null: none.
    std::shared_ptr<PartialSources> partial_sources;
    // Number of threads in total. Files that are ingested at the same time share them. A single
    // file uses all threads.
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
    // Time for which the members of an archive are ingested before other work has its turn. The
    // result is then `incomplete` with has_next_turn, and the next call continues with the next
    // member. None: all members are ingested in one call.
    std::optional<std::chrono::milliseconds> archive_turn;
    // Called for each file after it was read and before it is used. If it returns an error, for
    // example because the file has changed since it was cataloged, the file is rejected. Empty:
    // every file is accepted.
    ReadCheck check_read;
};

}  // namespace stormcellar::pipeline
