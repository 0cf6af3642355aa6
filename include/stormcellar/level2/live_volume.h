// stormcellar/level2/live_volume.h -- joins the chunks of a volume, which may arrive in any order.
//
// Each chunk is decoded once, when it comes. take_sweeps() returns sweeps as they close, and again
// when a late chunk changes them. finish() returns the volume of the chunks in the order of their
// numbers, bit for bit, in whatever order they came. For undamaged chunks this is what decode()
// returns for the joined chunks. The report lists the chunks that are missing or bad.
//
// A chunk that comes twice counts once. If two chunks of one number differ, the chunk that holds
// more is kept, whichever comes first. A start chunk of another volume shows that the radar has
// begun again. add() refuses that chunk, and the caller can finish the volume that has come so far.
// After a restart of the program, the caller adds the chunks in its directory again.
//
// Memory    With a depot, little more than the first and the last radial of each piece of a sweep.
//           The decompressed bytes of all chunks stay within the decoder's limit of output, and the
//           memory of all chunks within the decoder's limit of arrays. A chunk that would exceed a
//           limit is refused; only then does the order matter.
// Units     Sizes are in bytes.
// Threads   One thread at a time.
// Errors    See each function.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "stormcellar/level2/chunk_name.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/live_chunk.h"
#include "stormcellar/level2/live_sweep.h"

namespace stormcellar::level2 {

class VolumeBuilder;

struct LiveOptions {
    DecodeOptions decode;
    // If no chunk comes for this long, is_due() returns true.
    std::chrono::seconds timeout{600};
    // If the end has come but chunks are missing, is_due() returns true this long after the newest
    // chunk.
    std::chrono::seconds grace{30};
    // Stores the sweeps of chunks until they are needed. If `depot` is null, the sweeps stay in
    // memory. The depot must outlive the volume.
    SweepDepot* depot = nullptr;
};

class LiveVolume {
  public:
    using Clock = std::chrono::steady_clock;

    explicit LiveVolume(LiveOptions options = {}) : options_(std::move(options)) {}
    LiveVolume(const LiveVolume&) = delete;
    LiveVolume& operator=(const LiveVolume&) = delete;

    enum class Added : std::uint8_t {
        added,
        repeated,        // the same chunk had come before
        replaced,        // the new chunk holds more and replaces the old one
        worse,           // the new chunk holds less and is dropped
        another_volume,  // refused: its header differs from the first header of this number
    };
    // Adds a chunk that came at `now`. An error leaves the chunks that were added before unchanged:
    // - bad_argument for a number that is not within 1 to 999;
    // - not_level2, empty, corrupt or truncated for a chunk that holds nothing whole; finish()
    //   reports the bad chunk unless a good chunk of the same number comes;
    // - unsupported if the chunk exceeds a limit;
    // - exhausted if the system has no more memory; the caller should add the chunk again.
    [[nodiscard]] Result<Added> add(int number, ChunkKind kind, std::span<const std::byte> bytes,
                                    Clock::time_point now);

    // Returns the sweeps that have closed, or changed after they closed, since the last call, in
    // the order of the volume. Once the returned sweeps exceed most_live_bytes, the next call
    // returns the rest. Returns none if the system has no more memory; the next call tries again.
    [[nodiscard]] std::vector<LiveSweep> take_sweeps();
    // Returns the station, position and pattern known so far, without sweeps.
    [[nodiscard]] Volume facts() const;

    // Returns true if an end chunk, a radial marked as the last of the volume, or a chunk with
    // radials and a negative control word has come.
    [[nodiscard]] bool has_ended() const;
    // Returns the numbers for which no readable chunk has come. Numbers above the highest
    // readable chunk are left out.
    [[nodiscard]] std::vector<int> missing_numbers() const;
    // Returns true if no chunk is missing from the first to the end.
    [[nodiscard]] bool is_whole() const { return has_ended() && missing_numbers().empty(); }
    // Returns true if the volume is whole, if no chunk has come for `timeout`, or if the end has
    // come and no chunk has come for `grace`. An empty volume is never due.
    [[nodiscard]] bool is_due(Clock::time_point now) const;
    [[nodiscard]] bool is_empty() const { return chunks_.empty(); }
    // Returns the memory of the decoded chunks, without the sweeps in the depot.
    [[nodiscard]] std::uint64_t held_bytes() const;

    // Joins the chunks and leaves the volume empty. Errors: those of decode() and of the depot;
    // empty if no chunk came; corrupt if only unreadable chunks came.
    [[nodiscard]] Result<Decoded> finish();

  private:
    // Returns the room that all other chunks leave for the chunk of this number.
    [[nodiscard]] LiveRoom room_for(int number) const;
    [[nodiscard]] Result<Added> keep_better(int number, LiveChunk chunk, Clock::time_point now);
    [[nodiscard]] std::vector<LiveSweep> changed_sweeps();
    [[nodiscard]] Result<Decoded> join_all();
    void name_lost_chunks(VolumeBuilder& builder) const;

    LiveOptions options_;
    std::map<int, LiveChunk> chunks_;
    std::map<int, VolumeHeader> headers_;  // for each number, the first header that came
    std::map<int, std::string> refused_;   // the reasons, for numbers with only bad chunks
    std::uint64_t next_serial_ = 0;
    Clock::time_point last_arrival_;
    std::set<std::uint64_t> handed_out_;  // checksums over the pieces of each returned sweep
};

}  // namespace stormcellar::level2
