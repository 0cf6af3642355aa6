// level2/decode/sweep_rows.h -- the arrays of a SweepMoment as they grow, row by row.
//
// Rows of a moment that are fewer than its sweep's radials stand for radials that lack it; pad()
// makes them. Codes beyond a row's gates are 0.
#pragma once

#include <cstddef>
#include <cstdint>

#include "level2/messages/radial_message.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2::rows {

// Rows of one kind can stand in one array: the same moment, gates, word size, scale and offset.
[[nodiscard]] bool same_kind(const SweepMoment& moment, const MomentBlock& block);
[[nodiscard]] bool same_kind(const SweepMoment& a, const SweepMoment& b);

// A moment without rows, of the kind of this block or of another moment.
[[nodiscard]] SweepMoment empty_like(const MomentBlock& block);
[[nodiscard]] SweepMoment empty_like(const SweepMoment& moment);

[[nodiscard]] std::uint64_t bytes_per_code(const SweepMoment& moment);

// Makes room for rows of the present length, at most 4 MiB.
void reserve(SweepMoment& moment, std::size_t rows);
// Gives the rows another length; codes beyond the new length are dropped.
void set_stride(SweepMoment& moment, std::int32_t stride);
// The length that rows get so that ever longer radials are not copied ever again: `gates`, but a
// quarter more than now where there are rows.
[[nodiscard]] std::int32_t grown_stride(const SweepMoment& moment, std::int32_t gates);
// Rows of no gates until there are `rows`.
void pad(SweepMoment& moment, std::size_t rows);
// One row; `block.gates` is at most the stride.
void append(SweepMoment& moment, const MomentBlock& block);
// All rows of another moment of this kind, whose stride is at most this one's.
void append(SweepMoment& moment, const SweepMoment& from);
// What arrays larger than reserve() makes them have room for beyond their codes.
[[nodiscard]] std::uint64_t idle_bytes(const SweepMoment& moment);
// A row for every radial in every moment, none longer than the longest; what was reserved and is
// not in use is given back.
void make_whole(Sweep& sweep);

}  // namespace stormcellar::level2::rows
