// pipeline/ingest.h -- one raw file -> catalog -> grid in the cache.
//
// Shared by the daemon and the CLI. Never changes the raw file. A file that cannot be decoded is
// recorded as rejected with its reason; that is a result, not an error.
// A grid in the cache is replaced by one of a whole volume or of a newer file, never by one of a
// part of it or of an older file. A volume that the cache's budgets would not keep is not gridded.
// Errors are not of the data: the catalog or the cache cannot be written, the system gives no
// memory or descriptors. Trying again later may help.
// Thread contract: an Ingestor may be used by many threads at once, for different files.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "cache/store.h"
#include "catalog/catalog.h"
#include "grid/gridder.h"
#include "pipeline/domain.h"
#include "pipeline/frames_when.h"

namespace stormcellar::pipeline {

// What growing volumes may have put aside on disk, packed, so that little is held in memory: of
// files that are followed, with what stands of the sites' last volumes, and of chunks each. Of a
// feed of 160 sites either takes 1 to 3 GB.
inline constexpr std::uint64_t most_put_aside_bytes = std::uint64_t{4} << 30;

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
    // Of volumes that come as one file a chunk (level2/live_volume.h).
    std::chrono::seconds chunk_timeout{600};
    std::chrono::seconds chunk_grace{30};
    // See above. Beyond it what has not grown for longest is given up, and read again from its
    // files.
    std::uint64_t put_aside_bytes = most_put_aside_bytes;
};

struct IngestOptions {
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
    std::uint64_t most_output_bytes = std::uint64_t{256} << 20;
};

enum class IngestResult {
    gridded,      // registered, and every volume with the moment is in the cache, or too old for it
    no_moment,    // registered; holds no sweep of the moment, so there is nothing to grid
    no_position,  // registered; neither the file nor the table says where the radar stands
    incomplete,   // not settled: the volume has not ended and finish_partial is false, or the file
                  // changed while it was read; ask again when it was closed or quiet
    rejected,     // registered as rejected: no volume, or none that can be gridded
    unchanged,    // settled before; nothing was done
    vanished,    // the file is gone; its rows, if any, are marked so. One in whose name a volume of
                 // chunks waits is incomplete instead, and to be asked for again all the same
    registered,  // registered; the Ingestor has no cache
};

struct IngestOutcome {
    IngestResult result = IngestResult::rejected;
    std::string station;  // empty: unknown
    std::optional<UtcTime> volume_time;
    std::optional<UtcTime> newest_radial;    // by the radar's clock; plausible times alone
    std::optional<ErrorCode> rejected_with;  // of what kind the reason is; rejected files alone
    std::string reason;     // why rejected, or what is wrong or worth saying; one line
    bool followed = false;  // incomplete: what is appended will be read without the rest
    bool partial = false;   // gridded: some volume had not ended, or was damaged
    std::vector<std::filesystem::path> grids;
    std::vector<std::filesystem::path> partials;  // for mosaics (pipeline/mosaic_keeper.h)
    std::vector<std::filesystem::path> frames;    // of mosaics that it changed
    std::vector<int> missing_chunks;              // of a volume of chunks that was finished
    std::vector<std::filesystem::path> living;    // of volumes that have not ended
    bool living_left_out = false;                 // for want of time
    // Growing volumes that made room for this one: what was put aside of them is gone, and they are
    // read again from their files.
    std::uint64_t given_up = 0;
    // Of a volume of chunks, incomplete: the one that was to be asked again until this one came.
    std::filesystem::path instead_of;
    int not_kept = 0;  // volumes that the cache's budgets do not keep: nothing was made of them
    double read_s = 0, decode_s = 0, grid_s = 0, commit_s = 0, mosaic_s = 0;
};

class MosaicKeeper;

class Ingestor {
  public:
    Ingestor(catalog::Catalog& catalog, const cache::Store& store, IngestOptions options);
    // Without a cache: files are decoded and registered, and not gridded.
    Ingestor(catalog::Catalog& catalog, IngestOptions options);
    ~Ingestor();
    Ingestor(const Ingestor&) = delete;
    Ingestor& operator=(const Ingestor&) = delete;

    // finish_partial: grid a volume that has not ended (the file was quiet long enough).
    Result<IngestOutcome> ingest(const std::filesystem::path& path, bool finish_partial);
    // Writes a file into the catalog as seen, unread, unless it stands there (registered), or marks
    // its rows when it is gone (vanished; registered where a volume of chunks waits in its name).
    Result<IngestResult> note(const std::filesystem::path& path);
    // The same as ingest() for a file that was settled before: its volumes are gridded again, as
    // they are.
    Result<IngestOutcome> ingest_again(const std::filesystem::path& path);

    [[nodiscard]] MosaicKeeper& mosaics();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::pipeline
