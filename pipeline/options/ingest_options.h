// pipeline/options/ingest_options.h -- how files are ingested (pipeline/ingest/ingest.h).
//
// Thread contract: plain data.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/options/domain.h"
#include "pipeline/options/frames_when.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/level2/selection.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

// How much growing volumes may have on the shelf, packed on disk, so that memory holds little. The
// limit is for followed files with the standing sweeps of the sites' last volumes, and again for
// chunks. For a feed of 160 sites each takes 1 to 3 GB.
inline constexpr std::uint64_t most_shelf_bytes = std::uint64_t{4} << 30;

// How much a file, or the chunks of a volume, may unpack to: three times a large volume.
inline constexpr std::uint64_t most_unpacked_bytes = std::uint64_t{256} << 20;

// How much the arrays of a volume with these moments may take: twice what any known volume takes,
// whose largest moment has 14 MiB.
[[nodiscard]] inline std::uint64_t most_array_bytes(const level2::Selection& selection) {
    const std::uint64_t moments =
        selection.moments.empty() ? std::size(level2::all_moments) : selection.moments.size();
    return (16 + 28 * moments) << 20;
}

// How volumes are gridded while they grow: each sweep as it closes, and the standing sweeps of the
// last volume until theirs has come.
struct LivingGrids {
    // The directory of the shelf, whose files have no names. Empty: there are no living grids, and
    // a volume that comes as one file a chunk consists of the chunks that are there when it is
    // finished.
    std::filesystem::path scratch;
    bool make = true;  // false: none are made, but chunks are joined all the same
    // Called before each living grid: returns false while there is more urgent work; the sweeps are
    // then in the next grid. Not called for a new low sweep. Empty: there is always time.
    std::function<bool()> has_time;
    // For volumes that come as one file a chunk (stormcellar/level2/live_volume.h).
    std::chrono::seconds chunk_timeout{600};
    std::chrono::seconds chunk_grace{30};
    // See above. Beyond it, what has not grown for longest is given up, and read again from its
    // files.
    std::uint64_t shelf_bytes = most_shelf_bytes;
    // How many files, volumes of chunks, and last volumes of sites may be held; each has a
    // descriptor.
    std::size_t count = 320;
};

// Says whether to process a file that was read, by its size and hash; its error says why not. The
// threads that ingest call it.
using ReadCheck = std::function<Status(const std::filesystem::path& path, std::uint64_t size_bytes,
                                       std::uint64_t content_hash)>;

struct IngestOptions {
    // Whose data are accepted; null: those of every station with a name. Data of all others are
    // cataloged among those of no known station, and neither followed nor gridded.
    std::shared_ptr<StationRule> stations;
    level2::Moment moment = level2::Moment::ref;
    double spacing_m = 1000;
    int nx = 460, ny = 460;
    std::vector<double> levels_m;  // empty: the default 32
    std::vector<Domain> domains;   // mosaics to make, beside each site's own grid
    bool own_grids = true;         // false: only the sites' grids for the domains
    FramesWhen frames = FramesWhen::volume_comes;
    // In all: files that are ingested at the same time share them; a file that is alone uses all.
    int decode_threads = 1;
    int grid_threads = 1;
    LivingGrids living;
    // Nothing outside of this directory is opened, wherever links lead (base/beneath.h); empty: a
    // file may be anywhere.
    std::filesystem::path beneath;
    // A larger file is rejected unread. No known volume takes half of it.
    std::uint64_t most_file_bytes = std::uint64_t{256} << 20;
    // A file that unpacks to more is rejected too.
    std::uint64_t most_output_bytes = most_unpacked_bytes;
    // How long one turn of an archive may take. After that the archive is incomplete, and continues
    // with the next member when it is offered again (ended::Incomplete). None: all members in one
    // turn.
    std::optional<std::chrono::milliseconds> archive_turn;
    // Called for each file that was read, before anything is made of it. Its error rejects the
    // file, for example because it is no longer the file that was cataloged. Empty: every file is
    // accepted.
    ReadCheck check_read;
};

}  // namespace stormcellar::pipeline
