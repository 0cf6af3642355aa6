// level2/decode/array_room.h -- counts the memory of arrays before they are made, and enforces a
// limit.
//
// For each of its radials, a sweep takes one row of each kind of a moment (kinds differ in gates,
// scale or word size), as long as the longest row of the kind, and some bytes for each kind. The
// count does not depend on whether radials come one by one or in pieces. The pieces of a sweep
// never count for more than the sweep: for a piece that may continue an earlier one, the sweep
// itself and its kinds are not counted. So a volume that exceeds its limit does so however it was
// cut into fragments.
//
// Units     Bytes.
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// The largest known sweep takes 7 MB. Arrays are copied as they grow, so no sweep may be large.
inline constexpr std::uint64_t most_sweep_bytes = std::uint64_t{64} << 20;
// The least size of a sweep, and of each kind in it, including the allocator's share.
inline constexpr std::uint64_t empty_sweep_bytes = 1024;
inline constexpr std::uint64_t empty_kind_bytes = 320;

[[nodiscard]] std::uint64_t bytes_of(const Vcp& vcp);

// Returns the error for a system without more memory. Its code is exhausted, because the input is
// not to blame and may be decoded after others have returned their memory.
[[nodiscard]] tl::unexpected<Error> no_memory();

class ArrayRoom {
  public:
    // Returns the new limit, or 0 if there is no more room. It is called once: when the first limit
    // is reached, or when all room is requested.
    using More = std::function<std::uint64_t()>;

    explicit ArrayRoom(std::uint64_t limit_bytes, More more = {})
        : limit_bytes_(limit_bytes), more_(std::move(more)) {}

    // Each of these returns false if the limit is exceeded; counted bytes stay counted.
    [[nodiscard]] bool add(std::uint64_t bytes);
    [[nodiscard]] bool begin_sweep();
    // Begins a piece that may continue a sweep that was already counted.
    void continue_sweep();
    [[nodiscard]] bool add_radials(std::size_t count);
    // Counts rows of the sweep's moment number `moment` with at least this many gates each.
    [[nodiscard]] bool widen(std::size_t moment, std::size_t gates, std::uint64_t bytes_per_code);

    [[nodiscard]] std::uint64_t taken_bytes() const { return closed_bytes_ + sweep_bytes(); }
    [[nodiscard]] std::uint64_t left_bytes() const;
    void set_limit(std::uint64_t limit_bytes) { limit_bytes_ = limit_bytes; }
    // Requests all room before it is needed. Returns false if there is no more.
    bool ask_for_more();
    // Frees all room.
    void clear();

  private:
    [[nodiscard]] std::uint64_t sweep_bytes() const {
        return radials_ * row_bytes_ + gates_.size() * kind_bytes_;
    }
    [[nodiscard]] bool holds();

    std::uint64_t limit_bytes_;
    More more_;
    std::uint64_t closed_bytes_ = 0;  // all but the newest sweep
    std::uint64_t radials_ = 0;       // of the newest sweep
    std::uint64_t row_bytes_ = sizeof(Radial);
    std::uint64_t kind_bytes_ = 0;
    std::vector<std::size_t> gates_;  // gates of its moments
};

}  // namespace stormcellar::level2
