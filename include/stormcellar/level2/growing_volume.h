// stormcellar/level2/growing_volume.h -- decodes a file while it grows.
//
// Bytes are appended as they come, in pieces of any size. Each LDM record, or each message of an
// uncompressed file, is decoded as soon as it is whole, and sweeps are handed out as they close. A
// file that is compressed as a whole (gzip, bzip2, .Z) cannot be read before it is complete; it is
// held until the end, up to most_packed_bytes.
//
// finish() returns what decode() returns for the same bytes, bit for bit, also for damaged files.
// There are two exceptions, which are refused: more than 34 MiB in which no LDM record ends, and 16
// MiB that hold neither a record nor a message. After a restart of the program the file is appended
// again from its start.
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

    // Appends bytes. An error is final: no more bytes are taken, and finish() returns it again.
    [[nodiscard]] Status append(std::span<const std::byte> bytes);
    // Returns the sweeps that have closed since the last call, in the order of the file. A sweep is
    // closed by the status of its last radial or by the sweep that follows. If a sweep goes on
    // after its last radial, it is returned again when it has grown by a quarter, and again when
    // another sweep follows. If radials of it come late, it is returned again with these. Once the
    // sweeps exceed most_live_bytes, the rest comes with the next call.
    [[nodiscard]] std::vector<LiveSweep> take_sweeps();
    // Returns station, position and pattern as far as they are known, without sweeps.
    [[nodiscard]] Volume facts() const;
    // Returns true if the newest radial is marked as the last of the volume, or the newest record
    // has a negative control word and there are radials. More may follow all the same.
    [[nodiscard]] bool has_ended() const;

    // Returns true if the newest radial is marked as the last, whatever the control words say.
    [[nodiscard]] bool has_last_radial() const;
    // Returns true if the file consists of LDM records, so that bytes are decoded at once and not
    // held until the end.
    [[nodiscard]] bool is_of_records() const;
    // Returns true if a further volume has begun in the file.
    [[nodiscard]] bool holds_several() const;

    // Returns the bytes held now: sweeps that were not dropped, an unfinished record or message,
    // and a file that must be complete before it is read. The number is approximate, because it
    // leaves out what the allocator adds.
    [[nodiscard]] std::uint64_t held_bytes() const;

    // These three let the caller hold less memory. Sweeps below droppable_sweeps() are closed and
    // were handed out, and take_sweeps() last returned exactly what the volume holds of them. Each
    // may be dropped once, and again when it was returned again, and must be put back, bit for bit,
    // before finish(). Who drops sweeps also gives the function that returns a dropped sweep: it is
    // called when radials of that sweep come late.
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
