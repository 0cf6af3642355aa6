// pipeline/options/ingest_outcome.h -- the result of ingesting a file (pipeline/ingest/ingest.h).
//
// Threads   Plain data.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::pipeline {

// The results of ingesting a file. Facts that belong to only one of these results are in ended::X
// below.
enum class IngestResult {
    // Registered, and the cache has the site's own grid of a volume of the file, or the cache's
    // budgets do not keep that grid. If sites' own grids are not made, a partial counts instead.
    gridded,
    no_moment,      // registered, but nothing to grid: no sweep has the moments
    no_position,    // registered, but neither the file nor the table has the position
    other_station,  // registered, but not gridded: its station is not accepted
    // Not settled, because the volume has not ended and finish_as_is is false, or the file changed
    // while it was read, or an archive has more members than one turn takes. Offer the file again
    // when it was closed or has been quiet, or at once if has_next_turn is true.
    incomplete,
    rejected,   // registered as rejected: has no volume that can be gridded
    unchanged,  // settled before; nothing was done
    // The file is gone, and its rows, if any, are marked as gone. But if the file represents a
    // volume in chunks that may continue, the result is `incomplete`; then offer the file again
    // although it is gone.
    vanished,
    // Registered, and nothing else must be done: the Ingestor has no cache, or the file is a chunk
    // of a growing volume that another chunk represents.
    registered,
};

namespace ended {

template <IngestResult value>
struct WithoutFacts {
    static constexpr IngestResult result = value;
};
using Gridded = WithoutFacts<IngestResult::gridded>;
using NoMoment = WithoutFacts<IngestResult::no_moment>;
using NoPosition = WithoutFacts<IngestResult::no_position>;
using OtherStation = WithoutFacts<IngestResult::other_station>;
using Unchanged = WithoutFacts<IngestResult::unchanged>;
using Vanished = WithoutFacts<IngestResult::vanished>;
using Registered = WithoutFacts<IngestResult::registered>;

struct Incomplete {
    static constexpr IngestResult result = IngestResult::incomplete;
    bool is_followed = false;    // the next call will read only what is appended
    bool has_next_turn = false;  // this is an archive that can continue at once
};
struct Rejected {
    static constexpr IngestResult result = IngestResult::rejected;
    ErrorCode with = ErrorCode::internal;  // the code of the error that caused the rejection
};

}  // namespace ended

using Ending = std::variant<ended::Gridded, ended::NoMoment, ended::NoPosition, ended::OtherStation,
                            ended::Incomplete, ended::Rejected, ended::Unchanged, ended::Vanished,
                            ended::Registered>;

struct IngestOutcome {
    Ending ending = ended::Rejected{};
    [[nodiscard]] IngestResult result() const {
        return std::visit([](const auto& end) { return end.result; }, ending);
    }

    // Facts about the file.
    std::string station;                   // empty: unknown, or not accepted
    std::optional<UtcTime> volume_time;    // start of the first volume
    std::optional<UtcTime> newest_radial;  // by the radar's clock; only plausible times
    std::string reason;                    // why it was rejected, or another remark; one line
    // True if the file looks like one chunk of a volume, but is not named like a chunk.
    bool lone_chunk = false;

    // Grids of the file's volumes.
    bool partial = false;                         // some gridded volume was incomplete or damaged
    std::vector<std::filesystem::path> grids;     // new grids, and better grids that stay
    std::vector<std::filesystem::path> partials;  // for mosaics (pipeline/mosaic/mosaic_maker.h)
    std::vector<std::filesystem::path> frames;    // of mosaics, made again with these partials
    bool no_room = false;                         // the cache's budgets left no room for some grid
    int not_kept = 0;  // number of own grids of sites that the cache's budgets do not keep

    // State of the file's volume, if it grows or grew.
    bool goes_on = false;  // the volume is followed, and one of its sweeps is complete
    std::vector<std::filesystem::path> living;  // grids of volumes that have not ended
    int dealiased_sweeps = 0;                   // dealiased for living grids
    bool living_left_out = false;               // there was no time for living grids
    // Numbers of the chunks that a finished volume lacks.
    std::vector<int> missing_chunks;
    // Number of growing volumes that were given up because of a limit. Their sweeps on disk are
    // gone, and they are read again from their files.
    std::uint64_t given_up = 0;
    // The chunk that represented the volume until this chunk came.
    std::filesystem::path former_representative;

    // Time that each step took.
    double read_s = 0, decode_s = 0, grid_s = 0, commit_s = 0, mosaic_s = 0;
};

// The result for a file that was only noted, and not read.
enum class Noted {
    stands,  // the file must still be passed to Ingestor::ingest()
    gone,    // the file is gone, and nothing is left to do
};

}  // namespace stormcellar::pipeline
