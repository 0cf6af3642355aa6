// pipeline/options/ingest_options.h -- how files are taken in (pipeline/ingest/ingest.h).
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
#include "stormcellar/base/result.h"
#include "stormcellar/base/station_rule.h"
#include "stormcellar/level2/selection.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

// What growing volumes may have put aside on disk, packed, so that little is held in memory: of
// files that are followed, with what stands of the sites' last volumes, and of chunks each. Of a
// feed of 160 sites either takes 1 to 3 GB.
inline constexpr std::uint64_t most_shelf_bytes = std::uint64_t{4} << 30;

// What a file, or the chunks of a volume, may unpack to: three times a large volume.
inline constexpr std::uint64_t most_unpacked_bytes = std::uint64_t{256} << 20;

// What the arrays of a volume may take of which these moments are asked for: twice what any known
// volume takes, whose largest moment has 14 MiB.
[[nodiscard]] inline std::uint64_t most_array_bytes(const level2::Selection& selection) {
    const std::uint64_t moments =
        selection.moments.empty() ? std::size(level2::all_moments) : selection.moments.size();
    return (16 + 28 * moments) << 20;
}

// Volumes that are gridded while they grow: each sweep as it closes, and the last volume's until
// theirs has come.
struct LivingGrids {
    // A directory for what is put aside, in files without names; empty: none are made, and of
    // volumes that come as one file a chunk all that lies there is a volume when it is finished.
    std::filesystem::path scratch;
    bool make = true;  // false: none are made, and chunks are put together all the same
    // Asked before each: false while there is more urgent work. The sweeps are in the next one.
    // Not asked for what shows a new low sweep. Empty: there is always time.
    std::function<bool()> has_time;
    // Of volumes that come as one file a chunk (stormcellar/level2/live_volume.h).
    std::chrono::seconds chunk_timeout{600};
    std::chrono::seconds chunk_grace{30};
    // See above. Beyond it what has not grown for longest is given up, and read again from its
    // files.
    std::uint64_t shelf_bytes = most_shelf_bytes;
    // So many files, volumes of chunks, and sites' last volumes, each with a descriptor.
    std::size_t count = 320;
};

// Says of a file that was read, by its size and hash, whether something is to be made of it; its
// error says why not. Called by the threads that ingest.
using ReadCheck = std::function<Status(const std::filesystem::path& path, std::uint64_t size_bytes,
                                       std::uint64_t content_hash)>;

struct IngestOptions {
    // Of which stations data are taken in; null: of every one that has a name. Data of all others
    // are cataloged among those of no known station, and neither followed nor gridded.
    std::shared_ptr<StationRule> stations;
    level2::Moment moment = level2::Moment::ref;
    double spacing_m = 1000;
    int nx = 460, ny = 460;
    std::vector<double> levels_m;  // empty: the default 32
    std::vector<Domain> domains;   // mosaics to keep, beside each site's own grid
    bool own_grids = true;         // false: the sites' grids for the domains alone
    FramesWhen frames = FramesWhen::volume_comes;
    // In all: files that are ingested at the same time share them, so that each has its part and
    // one alone has all.
    int decode_threads = 1;
    int grid_threads = 1;
    LivingGrids living;
    // Nothing outside of this directory is opened, wherever links lead (base/beneath.h); empty: a
    // file may lie anywhere.
    std::filesystem::path beneath;
    // A larger file is rejected unread. No volume is known that takes half of it.
    std::uint64_t most_file_bytes = std::uint64_t{256} << 20;
    // Likewise one that unpacks to more.
    std::uint64_t most_output_bytes = most_unpacked_bytes;
    // For so long the members of an archive are taken in at a time; then the archive is incomplete,
    // and goes on with the next one when it is offered again (ended::Incomplete). None: all at
    // once.
    std::optional<std::chrono::milliseconds> archive_turn;
    // Asked of each file that was read, before anything is made of it: its error rejects the file,
    // as where it is no longer the one that was cataloged. Empty: every file is taken.
    ReadCheck check_read;
};

}  // namespace stormcellar::pipeline
