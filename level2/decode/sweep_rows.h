// level2/decode/sweep_rows.h -- grows, cuts and moves the arrays of a SweepMoment by rows.
//
// If a moment has fewer rows than its sweep has radials, the last radials lack the moment; pad()
// adds rows without gates for them. Codes beyond the gates of a row are 0.
//
// Threads   One thread at a time for each moment.
#pragma once

#include <cstddef>
#include <cstdint>

#include "level2/messages/radial_message.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2::rows {

// Returns true if the rows of both can be in one array: same moment, first gate, gate spacing, word
// size, scale and offset.
[[nodiscard]] bool same_kind(const SweepMoment& moment, const MomentBlock& block);
[[nodiscard]] bool same_kind(const SweepMoment& a, const SweepMoment& b);

// Returns a SweepMoment without rows, with the kind and row length of the argument.
[[nodiscard]] SweepMoment empty_like(const MomentBlock& block);
[[nodiscard]] SweepMoment empty_like(const SweepMoment& moment);

[[nodiscard]] std::uint64_t bytes_per_code(const SweepMoment& moment);

// Reserves memory for `rows` rows of the present length, but at most 4 MiB.
void reserve(SweepMoment& moment, std::size_t rows);
// Changes the length of rows. Codes beyond the new length are dropped.
void set_stride(SweepMoment& moment, std::int32_t stride);
// Returns a new row length for rows of `gates` gates. If there are rows, it is at least a quarter
// more than the present length, so that ever longer radials do not cause a copy each time.
[[nodiscard]] std::int32_t grown_stride(const SweepMoment& moment, std::int32_t gates);
// Appends rows without gates until there are `rows`.
void pad(SweepMoment& moment, std::size_t rows);
// Appends one row; `block.gates` is at most the stride.
void append(SweepMoment& moment, const MomentBlock& block);
// Appends all rows of `from`, which has the same kind and no larger stride.
void append(SweepMoment& moment, const SweepMoment& from);
// Returns the rows [first, end) of a sweep as a new sweep, with the kinds that have gates in these
// rows. Pads the moments of `sweep`.
[[nodiscard]] Sweep part_of(Sweep& sweep, std::size_t first, std::size_t end);
// Moves the last `count` rows of a sweep so that they begin at row `at`.
void move_last_rows(Sweep& sweep, std::size_t count, std::size_t at);
// Returns the reserved but unused bytes of an array larger than 4 MiB; 0 for smaller arrays.
[[nodiscard]] std::uint64_t idle_bytes(const SweepMoment& moment);
// Gives every moment a row for every radial, shortens the rows to the largest gate count, and frees
// most of the unused memory.
void make_whole(Sweep& sweep);

}  // namespace stormcellar::level2::rows
