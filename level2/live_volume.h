// level2/live_volume.h -- puts together a volume that arrives in chunks, in any order.
//
// Each chunk is decoded when it comes and never again. Sweeps come out as they close, and again
// when a late chunk makes them better. finish() gives what the chunks give in the order of their
// numbers, bit for bit, whatever the order in which they came; for undamaged chunks that is what
// decode() gives for them joined.
// A chunk that comes twice counts once. Where two differ, the one that holds more is kept, which
// does not depend on the order either. A start chunk of another volume shows that the radar has
// begun again: it is refused, and what there is can be finished.
// After a restart of the program the chunks that lie there are added again.
// Memory: the arrays of all chunks together, and their decompressed bytes, stay under the decoder's
// output limit; a chunk that would go beyond is refused.
// Thread contract: one thread at a time.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "level2/chunk_name.h"
#include "level2/decode.h"
#include "level2/fragment.h"
#include "level2/live_sweep.h"
#include "level2/part_decoder.h"

namespace stormcellar::level2 {

struct LiveOptions {
    DecodeOptions decode;
    // A volume to which nothing has come for so long is given up as it is.
    std::chrono::seconds timeout{600};
    // Once its end is there, late chunks are waited for so long.
    std::chrono::seconds grace{30};
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
    // unsupported beyond the limits. The volume stays as it was.
    [[nodiscard]] Result<Added> add(int number, ChunkKind kind, std::span<const std::byte> bytes,
                                    Clock::time_point now);

    // The sweeps that have closed or changed since the last call, in the volume's order.
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

    // Gives up the volume; nothing is left. Errors: those of decode().
    [[nodiscard]] Result<Decoded> finish();

  private:
    struct Chunk {
        std::optional<VolumeHeader> header;  // at its start
        std::vector<Fragment> fragments;     // of its records, in their order
        bool has_records = false;            // else plain messages
        bool negative = false;               // the last record's control word
        bool ended_volume = false;           // a radial says so
        std::size_t radials = 0;
        std::size_t bytes = 0;
        std::uint64_t output_bytes = 0;
        std::uint64_t array_bytes = 0;
        std::uint64_t checksum = 0;
        ChunkKind kind = ChunkKind::intermediate;
        std::uint64_t serial = 0;  // of its arrival
    };
    // A piece of a sweep: the chunk's serial number, and the piece's place in it.
    using PieceId = std::pair<std::uint64_t, std::size_t>;
    struct OpenSweep {
        std::vector<const Fragment::Piece*> pieces;
        std::vector<PieceId> ids;  // behind that of the chunk that gave the pattern
        std::optional<Vcp> pattern;
        bool closed = false;
    };

    class Grouper;
    [[nodiscard]] Result<Chunk> read_chunk(std::span<const std::byte> bytes) const;
    [[nodiscard]] bool has_room_for(const Chunk& chunk, int number) const;
    [[nodiscard]] std::vector<OpenSweep> sweeps_by_piece() const;
    [[nodiscard]] Sweep join(const OpenSweep& sweep) const;

    LiveOptions options_;
    std::map<int, Chunk> chunks_;
    std::uint64_t next_serial_ = 0;
    Clock::time_point last_arrival_;
    std::set<std::vector<PieceId>> handed_out_;
};

}  // namespace stormcellar::level2
