// pipeline/options/ingest_outcome.h -- the result of ingesting a file (pipeline/ingest/ingest.h).
//
// Threads   Plain data.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::pipeline {

enum class IngestResult {
    gridded,      // registered, and every volume with the moment is in the cache, or too old for it
    no_moment,    // registered; has no sweep of the moment, so there is nothing to grid
    no_position,  // registered; neither the file nor the table gives the position of the radar
    other_station,  // registered; its station's data are not accepted, so nothing is gridded
    incomplete,  // not settled: the volume has not ended and finish_partial is false, or the file
                 // changed while it was read; try again when it was closed or quiet
    rejected,    // registered as rejected: no volume, or none that can be gridded
    unchanged,   // settled before; nothing was done
    vanished,  // the file is gone, and its rows, if any, are marked so. If a volume of chunks waits
               // in its name, the result is incomplete instead, and the file is tried again
    registered,  // registered; the Ingestor has no cache
};

struct IngestOutcome {
    IngestResult result = IngestResult::rejected;
    std::string station;  // empty: unknown
    std::optional<UtcTime> volume_time;
    std::optional<UtcTime> newest_radial;    // by the radar's clock; only plausible times
    std::optional<ErrorCode> rejected_with;  // the kind of the reason; only for rejected files
    std::string reason;                      // why it was rejected, or a fault or remark; one line
    bool followed = false;  // incomplete: appended data will be read without reading the rest again
    // Incomplete or registered: its volume is followed, and one of its sweeps has closed.
    bool goes_on = false;
    bool has_next_turn = false;  // incomplete: an archive of which more can be ingested at once
    // It looks like one chunk of a volume, but its name is not that of a chunk.
    bool lone_chunk = false;
    bool partial = false;  // gridded: some volume had not ended, or was damaged
    std::vector<std::filesystem::path> grids;
    std::vector<std::filesystem::path> partials;  // for mosaics (pipeline/mosaic/mosaic_keeper.h)
    std::vector<std::filesystem::path> frames;    // of mosaics that it changed
    std::vector<int> missing_chunks;              // of a volume of chunks that was finished
    std::vector<std::filesystem::path> living;    // of volumes that have not ended
    bool living_left_out = false;                 // for lack of time
    // Growing volumes that made room for this one: their sweeps on disk are gone, and they are read
    // again from their files.
    std::uint64_t given_up = 0;
    // For a volume of chunks: the chunk that had to be tried again until this one came.
    std::filesystem::path instead_of;
    bool no_room = false;  // gridded: the cache's budgets left no room for some volume
    int not_kept = 0;      // volumes that the cache's budgets do not keep: nothing was made of them
    double read_s = 0, decode_s = 0, grid_s = 0, commit_s = 0, mosaic_s = 0;
};

}  // namespace stormcellar::pipeline
