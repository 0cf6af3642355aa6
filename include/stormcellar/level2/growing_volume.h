// stormcellar/level2/growing_volume.h -- decodes a file while it grows.
//
// Bytes are appended as they come, in pieces of any size. Each LDM record, or each message of an
// uncompressed file, is decoded as soon as it is whole, and sweeps are returned as they close. A
// file that is compressed as a whole (gzip, bzip2, .Z) cannot be read before it is complete; it is
// held until the end, up to most_packed_bytes.
//
// finish() returns what decode() returns for the same bytes, bit for bit, also for damaged files.
// Three kinds of input are refused instead: more than 34 MiB in which no LDM record ends, 16 MiB
// that hold neither a record nor a message, and more than most_packed_bytes of a file that must be
// held. After a restart of the program, the caller appends the file again from its start.
//
// Units     Sizes are in bytes.
// Threads   One thread at a time.
// Errors    Those of decode(), and over_budget for DecodeOptions::open_sweep_limit_bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

    // Appends bytes. An error is final: further calls of append() and finish() return the same
    // error.
    [[nodiscard]] Status append(std::span<const std::byte> bytes);
    // Returns the sweeps that have closed since the last call, in the order of the file. A sweep
    // closes with a radial whose status ends it, or when the next sweep begins. If radials of a
    // sweep follow its end, the sweep is returned again when it has grown by more than a quarter,
    // and when the next sweep begins. If late radials of an earlier sweep come, that sweep is
    // returned again with them. Once the returned sweeps exceed most_live_bytes, the next call
    // returns the rest. After an error, returns none.
    [[nodiscard]] std::vector<LiveSweep> take_sweeps();
    // Returns the station, position and pattern known so far, without sweeps.
    [[nodiscard]] Volume facts() const;
    // Returns true if the newest radial is marked as the last of the volume, or if there are
    // radials and the newest record has a negative control word. More bytes may still follow.
    [[nodiscard]] bool has_ended() const;

    // Returns true if the newest radial is marked as the last, whatever the control words say.
    [[nodiscard]] bool has_last_radial() const;
    // Returns true if the start of the file shows that it consists of LDM records. Each record is
    // then decoded as soon as it is whole.
    [[nodiscard]] bool is_of_records() const;
    // Returns true if a further volume has begun in the file.
    [[nodiscard]] bool holds_several() const;

    // Returns the bytes held now: sweeps that were not dropped, an unfinished record or message,
    // and a file that must be complete before it is read. The number leaves out the overhead of the
    // allocator.
    [[nodiscard]] std::uint64_t held_bytes() const;

    // These functions let the caller hold less memory. Sweeps with an index below
    // droppable_sweeps() are closed, and take_sweeps() has returned them. The caller may drop such
    // a sweep, and drop it again after take_sweeps() has returned it again. Before finish(), the
    // caller must put each dropped sweep back, bit for bit. A caller that drops sweeps must also
    // set the function that returns a dropped sweep; append() calls it when late radials of that
    // sweep may have come.
    [[nodiscard]] std::size_t droppable_sweeps() const;
    void drop_sweep(std::size_t index);
    void put_back(std::size_t index, Sweep sweep);
    using DroppedSweeps = std::function<Result<Sweep>(std::size_t index)>;
    void set_dropped_sweeps(DroppedSweeps dropped);

    [[nodiscard]] Result<Decoded> finish();

  private:
    class Reader;
    std::unique_ptr<Reader> reader_;
};

}  // namespace stormcellar::level2
