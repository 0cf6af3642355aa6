// stormcellar/level2/growing_volume.h -- decodes a file while it grows.
//
// Bytes are appended as they come, in pieces of any size. Each LDM record, or each message of an
// uncompressed file, is decoded as soon as it is whole, and sweeps are returned as they close. A
// file that is compressed as a whole (gzip, bzip2, .Z) cannot be read before it is complete; it is
// held until the end, up to most_packed_bytes.
//
// finish() returns what decode() returns for the same bytes, bit for bit, also for damaged files.
// Two kinds of input are refused instead: more than 34 MiB in which no LDM record ends, and 16 MiB
// that hold neither a record nor a message. After a restart of the program the file is appended
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

    // Appends bytes. An error is final: append() then takes no more bytes, and finish() returns the
    // error again.
    [[nodiscard]] Status append(std::span<const std::byte> bytes);
    // Returns the sweeps that have closed since the last call, in the order of the file. The status
    // of its last radial or the next sweep closes a sweep. If a sweep continues after its last
    // radial, it is returned again when it has grown by a quarter, and again when another sweep
    // follows. If late radials of a sweep come, it is returned again with them. Once the sweeps
    // exceed most_live_bytes, the next call returns the rest.
    [[nodiscard]] std::vector<LiveSweep> take_sweeps();
    // Returns station, position and pattern as far as they are known, without sweeps.
    [[nodiscard]] Volume facts() const;
    // Returns true if the newest radial is marked as the last of the volume, or if there are
    // radials and the newest record has a negative control word. More bytes may still follow.
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
    // leaves out the overhead of the allocator.
    [[nodiscard]] std::uint64_t held_bytes() const;

    // These three functions let the caller hold less memory. Sweeps below droppable_sweeps() are
    // closed, and take_sweeps() returned them exactly as the volume holds them. Each may be dropped
    // once, and again after it was returned again. The caller must put it back, bit for bit, before
    // finish(). A caller that drops sweeps also gives the function that returns a dropped sweep; it
    // is called when late radials of that sweep come.
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
