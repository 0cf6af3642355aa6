// level2/decode/sweep_rows.h -- grows the arrays of a SweepMoment row by row.
//
// If a moment has fewer rows than its sweep has radials, the missing rows stand for radials that
// lack the moment; pad() makes them. Codes beyond the gates of a row are 0.
//
// Threads   Plain functions; one thread at a time for each moment.
#pragma once

#include <cstddef>
#include <cstdint>

#include "level2/messages/radial_message.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2::rows {

// Returns true if the rows of both can be in one array: same moment, gates, word size, scale and
// offset.
[[nodiscard]] bool same_kind(const SweepMoment& moment, const MomentBlock& block);
[[nodiscard]] bool same_kind(const SweepMoment& a, const SweepMoment& b);

// Returns a moment without rows, of the kind of this block or of another moment.
[[nodiscard]] SweepMoment empty_like(const MomentBlock& block);
[[nodiscard]] SweepMoment empty_like(const SweepMoment& moment);

[[nodiscard]] std::uint64_t bytes_per_code(const SweepMoment& moment);

// Makes room for rows of the present length, at most 4 MiB.
void reserve(SweepMoment& moment, std::size_t rows);
// Changes the length of rows. Codes beyond the new length are dropped.
void set_stride(SweepMoment& moment, std::int32_t stride);
// Returns the new length for rows: `gates`, or a quarter more than now if there are rows. So
// radials that become longer and longer do not cause a copy each time.
[[nodiscard]] std::int32_t grown_stride(const SweepMoment& moment, std::int32_t gates);
// Appends rows without gates until there are `rows`.
void pad(SweepMoment& moment, std::size_t rows);
// Appends one row; `block.gates` is at most the stride.
void append(SweepMoment& moment, const MomentBlock& block);
// Appends all rows of another moment of this kind, whose stride is at most that of this one.
void append(SweepMoment& moment, const SweepMoment& from);
// Returns the rows [first, end) of a sweep as a sweep of its own, with the kinds that occur in
// them.
[[nodiscard]] Sweep part_of(Sweep& sweep, std::size_t first, std::size_t end);
// Moves the last `count` rows of a sweep so that they begin at row `at`.
void move_last_rows(Sweep& sweep, std::size_t count, std::size_t at);
// Returns the unused room in arrays that are larger than reserve() makes them.
[[nodiscard]] std::uint64_t idle_bytes(const SweepMoment& moment);
// Gives every moment a row for every radial, none longer than the longest, and frees memory that
// was reserved and is not in use.
void make_whole(Sweep& sweep);

}  // namespace stormcellar::level2::rows
