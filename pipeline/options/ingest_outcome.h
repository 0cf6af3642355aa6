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

// The ways in which ingesting a file can end. ended::X below has the facts that belong to only one
// ending.
enum class IngestResult {
    // Registered, and the cache has the site's own grid of some volume, or the cache's limits do
    // not keep that grid. If no own grids are made, a partial counts instead.
    gridded,
    no_moment,      // registered; there is nothing to grid, for example no sweep of the moments
    no_position,    // registered; neither the file nor the table gives the position of the radar
    other_station,  // registered; its station's data are not accepted, so nothing is gridded
    // Not settled: the volume has not ended and finish_as_is is false, or the file changed while it
    // was read, or an archive has more members than one turn takes. Offer the file again when it
    // was closed or is quiet, or at once if has_next_turn is true.
    incomplete,
    rejected,   // registered as rejected: no volume, or none that can be gridded
    unchanged,  // settled before; nothing was done
    // The file is gone, and its rows, if any, are marked as gone. If it represents a volume of
    // chunks that may continue, the result is `incomplete` instead; then offer it again although it
    // is gone.
    vanished,
    // Registered, and nothing else is to do: the Ingestor has no cache, or the file is a chunk of a
    // growing volume that another chunk represents.
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
    bool is_followed = false;    // the next call will read only appended data
    bool has_next_turn = false;  // this is an archive that can continue at once
};
struct Rejected {
    static constexpr IngestResult result = IngestResult::rejected;
    ErrorCode with = ErrorCode::internal;  // the code of the error that is the reason
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
    std::string reason;  // of a rejection, or another remark on the file; one line
    // The file looks like one chunk of a volume, but does not have the name of a chunk.
    bool lone_chunk = false;

    // Grids of the file's volumes.
    bool partial = false;                         // some gridded volume was incomplete or damaged
    std::vector<std::filesystem::path> grids;     // new ones, and better ones that stay
    std::vector<std::filesystem::path> partials;  // for mosaics (pipeline/mosaic/mosaic_maker.h)
    std::vector<std::filesystem::path> frames;    // of mosaics, made again with these partials
    bool no_room = false;                         // the cache's limits left no room for some grid
    int not_kept = 0;  // sites' own grids that the cache's limits do not keep, for any reason

    // State of the file's volume, if it grows or grew.
    bool goes_on = false;  // the volume is followed, and a sweep of it has closed
    std::vector<std::filesystem::path> living;  // grids of volumes that have not ended
    bool living_left_out = false;               // there was no time for living grids
    std::vector<int> missing_chunks;            // numbers that a finished volume of chunks lacks
    // The number of growing volumes that were given up because a limit was reached. Their sweeps on
    // disk are gone, and they are read again from their files.
    std::uint64_t given_up = 0;
    // The chunk that represented the volume until this one came.
    std::filesystem::path former_representative;

    // Time that each step took.
    double read_s = 0, decode_s = 0, grid_s = 0, commit_s = 0, mosaic_s = 0;
};

// The result for a file that was only noted, not read.
enum class Noted {
    stands,  // call Ingestor::ingest() for the file
    gone,    // the file is gone, and nothing is left to do
};

}  // namespace stormcellar::pipeline
