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

// The ways in which ingesting a file can end, for counts and names. ended::X below holds the facts
// that belong to only one of them.
enum class IngestResult {
    gridded,      // registered, and every volume with the moment is in the cache, or too old for it
    no_moment,    // registered; has no sweep of the moment, so there is nothing to grid
    no_position,  // registered; neither the file nor the table gives the position of the radar
    other_station,  // registered; its station's data are not accepted, so nothing is gridded
    // Not settled: the volume has not ended and finish_as_is is false, or the file changed while it
    // was read, or an archive has more members than one turn takes. The file must be offered again,
    // when it was closed or is quiet.
    incomplete,
    rejected,   // registered as rejected: no volume, or none that can be gridded
    unchanged,  // settled before; nothing was done
    // The file is gone, and its rows, if any, are marked so. If it represents a volume of chunks,
    // the result is incomplete instead, and the file must be offered again although it is gone.
    vanished,
    // Registered, with nothing else to do: the Ingestor has no cache, or the file is a chunk of a
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
    bool is_followed = false;    // only appended data will be read
    bool has_next_turn = false;  // an archive that can continue at once
};
struct Rejected {
    static constexpr IngestResult result = IngestResult::rejected;
    ErrorCode with = ErrorCode::internal;  // the kind of the reason
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
    std::string station;  // empty: unknown
    std::optional<UtcTime> volume_time;
    std::optional<UtcTime> newest_radial;  // by the radar's clock; only plausible times
    std::string reason;                    // why it was rejected, or a fault or remark; one line
    // It looks like one chunk of a volume, but its name is not that of a chunk.
    bool lone_chunk = false;

    // Grids, partials and frames that were made from it.
    bool partial = false;  // some volume was incomplete or damaged
    std::vector<std::filesystem::path> grids;
    std::vector<std::filesystem::path> partials;  // for mosaics (pipeline/mosaic/mosaic_maker.h)
    std::vector<std::filesystem::path> frames;    // of mosaics that it changed
    bool no_room =
        false;         // some volume was not gridded because the cache's limits left no room for it
    int not_kept = 0;  // volumes that were not gridded because the cache's limits keep no grid of
                       // them

    // State of the file's volume, if it grows or grew.
    bool goes_on = false;  // the volume is followed, and a sweep of it has closed
    std::vector<std::filesystem::path> living;  // grids of volumes that have not ended
    bool living_left_out = false;               // because there was no time
    std::vector<int> missing_chunks;            // of a volume of chunks that was finished
    // Growing volumes that were given up for this one: their sweeps on disk are gone, and they are
    // read again from their files.
    std::uint64_t given_up = 0;
    // The chunk that represented the volume until this one came.
    std::filesystem::path former_representative;

    // Time that each step took.
    double read_s = 0, decode_s = 0, grid_s = 0, commit_s = 0, mosaic_s = 0;
};

// The result for a file that was only noted, not read.
enum class Noted {
    stands,  // something is left to do: Ingestor::ingest()
    gone,    // nothing is left to do
};

}  // namespace stormcellar::pipeline
