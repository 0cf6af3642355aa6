// stormcellar/level2/growing_volume.h -- decodes a file as it grows.
//
// Bytes are appended as they come, cut anywhere. Each LDM record, or each message of an
// uncompressed file, is decoded as soon as it is whole, and the sweeps come out as they close.
// What cannot be read before it is whole (gzip, bzip2, .Z around it) is held until the end, up to
// most_packed_bytes. finish() gives what decode() gives for the same bytes, bit for bit, also for
// damaged files; but for more than 34 MiB in which no LDM record ends, and for 16 MiB that hold
// neither record nor message at all, which are refused.
// After a restart of the program the file is appended again from its start.
// Errors: those of decode(). Thread contract: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/live_sweep.h"

namespace stormcellar::level2 {

class GrowingVolume {
  public:
    explicit GrowingVolume(DecodeOptions options = {});
    GrowingVolume(GrowingVolume&&) noexcept;
    GrowingVolume& operator=(GrowingVolume&&) noexcept;
    ~GrowingVolume();

    // An error is final: no more is taken, and finish() gives it again.
    [[nodiscard]] Status append(std::span<const std::byte> bytes);
    // The sweeps that have closed since the last call, in the order of the file. A sweep is closed
    // by its last radial's status or by the sweep that follows. Where it goes on after its last
    // radial it comes again when it has grown by a quarter, and when another one follows. Of more
    // than most_live_bytes the rest comes with the next call.
    [[nodiscard]] std::vector<LiveSweep> take_sweeps();
    // Station, position and pattern as far as they are known; without sweeps.
    [[nodiscard]] Volume facts() const;
    // The newest radial is marked as the volume's last, or the newest record's control word is
    // negative and there are radials. More may follow all the same.
    [[nodiscard]] bool has_ended() const;

    // The newest radial is marked so, whatever the control words say.
    [[nodiscard]] bool has_last_radial() const;
    // LDM records: what is appended is decoded at once and not held until the end.
    [[nodiscard]] bool is_of_records() const;
    // A further volume has begun in the file.
    [[nodiscard]] bool holds_several() const;

    // What is held now: sweeps that were not dropped, an unfinished record or message, and what has
    // to be whole before it is read. About right: what the allocator adds is not counted.
    [[nodiscard]] std::uint64_t held_bytes() const;

    // To hold less: sweeps below this index are closed and were handed out, and what take_sweeps()
    // gave last of each is what the volume holds. They may be dropped, each once, and must be put
    // back, bit for bit, before finish().
    [[nodiscard]] std::size_t droppable_sweeps() const;
    void drop_sweep(std::size_t index);
    void put_back(std::size_t index, Sweep sweep);

    [[nodiscard]] Result<Decoded> finish();

  private:
    class Reader;
    std::unique_ptr<Reader> reader_;
};

}  // namespace stormcellar::level2
