// stormcellar/level2/live_volume.h -- puts together a volume that arrives in chunks, in any order.
//
// Each chunk is decoded when it comes and never again. Sweeps come out as they close, and again
// when a late chunk makes them better. finish() gives what the chunks give in the order of their
// numbers, bit for bit, whatever the order in which they came; for undamaged chunks that is what
// decode() gives for them joined, and the report names the chunks that are missing or bad.
// A chunk that comes twice counts once. Where two differ, the one that holds more is kept, which
// does not depend on the order either. A start chunk of another volume shows that the radar has
// begun again: it is refused, and what there is can be finished.
// After a restart of the program the chunks that lie there are added again.
// Memory: with a depot little but the first radial and the last of each stretch. What is held of
// all chunks together, and their decompressed bytes, stay under the decoder's output limit; a chunk
// that would go beyond is refused, and then the order does matter. Thread contract: one thread at a
// time.
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
    // A volume to which nothing has come for so long is given up as it is.
    std::chrono::seconds timeout{600};
    // Once its end is there, late chunks are waited for so long.
    std::chrono::seconds grace{30};
    // Where the gates of chunks lie until they are wanted; null: in memory. Outlives the volume.
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
        repeated,        // the same was there already
        replaced,        // it holds more than the one that was there
        worse,           // it holds less than the one that is there
        another_volume,  // a start chunk with another header: not taken
    };
    // Errors: not_level2, empty, corrupt or truncated for a chunk that holds nothing whole;
    // unsupported beyond the limits. The volume stays as it was; finish() names the chunk unless a
    // good one of its number comes. exhausted: the system gives no memory; nothing is known of the
    // chunk, which is to be added again. `now`: when the chunk came; the latest of all counts.
    [[nodiscard]] Result<Added> add(int number, ChunkKind kind, std::span<const std::byte> bytes,
                                    Clock::time_point now);

    // The sweeps that have closed or changed since the last call, in the volume's order. Of more
    // than most_live_bytes the rest comes with the next call.
    [[nodiscard]] std::vector<LiveSweep> take_sweeps();
    // Station, position and pattern as far as they are known; without sweeps.
    [[nodiscard]] Volume facts() const;

    // An end chunk, a radial marked as the volume's last, or a negative control word has come.
    [[nodiscard]] bool has_ended() const;
    // Numbers below the highest of which no chunk has come.
    [[nodiscard]] std::vector<int> missing_numbers() const;
    // From the first chunk to the end nothing is missing.
    [[nodiscard]] bool is_whole() const { return has_ended() && missing_numbers().empty(); }
    // Whole, or there is no use in waiting longer.
    [[nodiscard]] bool is_due(Clock::time_point now) const;
    [[nodiscard]] bool is_empty() const { return chunks_.empty(); }
    // What the decoded chunks take in memory, without what lies in the depot.
    [[nodiscard]] std::uint64_t held_bytes() const;

    // Gives up the volume; nothing is left. Errors: those of decode(), empty where no chunk came;
    // those of the depot.
    [[nodiscard]] Result<Decoded> finish();

  private:
    // Beside all others, instead of the one that has its number now.
    [[nodiscard]] LiveRoom room_for(int number) const;
    [[nodiscard]] Result<Added> keep_better(int number, LiveChunk chunk, Clock::time_point now);
    [[nodiscard]] std::vector<LiveSweep> changed_sweeps();
    [[nodiscard]] Result<Decoded> join_all();
    void name_lost_chunks(VolumeBuilder& builder) const;

    LiveOptions options_;
    std::map<int, LiveChunk> chunks_;
    std::map<int, VolumeHeader> headers_;  // of each number the first that came
    std::map<int, std::string> refused_;   // numbers of which only bad chunks came, and why
    std::uint64_t next_serial_ = 0;
    Clock::time_point last_arrival_;
    std::set<std::uint64_t> handed_out_;  // checksums of pieces
};

}  // namespace stormcellar::level2
