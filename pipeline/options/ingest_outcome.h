// pipeline/options/ingest_outcome.h -- what became of a file that was taken in
// (pipeline/ingest/ingest.h).
//
// Thread contract: plain data.
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
    no_moment,    // registered; holds no sweep of the moment, so there is nothing to grid
    no_position,  // registered; neither the file nor the table says where the radar stands
    other_station,  // registered; of no station that is taken in, so nothing is gridded
    incomplete,  // not settled: the volume has not ended and finish_partial is false, or the file
                 // changed while it was read; ask again when it was closed or quiet
    rejected,    // registered as rejected: no volume, or none that can be gridded
    unchanged,   // settled before; nothing was done
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
    // Incomplete or registered: its volume is followed, and a sweep of it has closed.
    bool goes_on = false;
    bool has_next_turn = false;  // incomplete: an archive of which more can be taken in at once
    // It looks like one chunk of a volume, and its name is none that chunks are put together by.
    bool lone_chunk = false;
    bool partial = false;  // gridded: some volume had not ended, or was damaged
    std::vector<std::filesystem::path> grids;
    std::vector<std::filesystem::path> partials;  // for mosaics (pipeline/mosaic/mosaic_keeper.h)
    std::vector<std::filesystem::path> frames;    // of mosaics that it changed
    std::vector<int> missing_chunks;              // of a volume of chunks that was finished
    std::vector<std::filesystem::path> living;    // of volumes that have not ended
    bool living_left_out = false;                 // for want of time
    // Growing volumes that made room for this one: what was put aside of them is gone, and they are
    // read again from their files.
    std::uint64_t given_up = 0;
    // Of a volume of chunks: the one that was to be asked again until this one came.
    std::filesystem::path instead_of;
    bool no_room = false;  // gridded: of some volume, but the cache's budgets left no room for it
    int not_kept = 0;      // volumes that the cache's budgets do not keep: nothing was made of them
    double read_s = 0, decode_s = 0, grid_s = 0, commit_s = 0, mosaic_s = 0;
};

}  // namespace stormcellar::pipeline
