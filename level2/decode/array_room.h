// level2/decode/array_room.h -- counts the memory of arrays before they are made, and enforces a
// limit.
//
// A moment of a sweep may come in several kinds, which differ in gates, scale or word size. Each
// kind takes some fixed bytes, and one row for each radial of the sweep. All rows of a kind are as
// long as its longest row. The radials of a sweep may come in several pieces
// (level2/decode/fragment_builder.h). A piece that may continue a sweep does not count the fixed
// bytes again, so the count does not depend on how a volume is cut into fragments.
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

// Limit for one sweep, because growing arrays are copied. The largest known sweep takes 7 MB.
inline constexpr std::uint64_t most_sweep_bytes = std::uint64_t{64} << 20;
// Fixed bytes of a sweep, and of each kind in it, including the overhead of the allocator.
inline constexpr std::uint64_t empty_sweep_bytes = 1024;
inline constexpr std::uint64_t empty_kind_bytes = 320;

[[nodiscard]] std::uint64_t bytes_of(const Vcp& vcp);

// Returns the error `exhausted` for a system without more memory. The input is not at fault and may
// decode later, when there is memory again.
[[nodiscard]] tl::unexpected<Error> no_memory();

class ArrayRoom {
  public:
    // Returns the new limit, or 0 if there is no more room. ArrayRoom calls it at most once: when
    // the first limit is reached, or in ask_for_more().
    using More = std::function<std::uint64_t()>;

    explicit ArrayRoom(std::uint64_t limit_bytes, More more = {})
        : limit_bytes_(limit_bytes), more_(std::move(more)) {}

    // These functions count bytes, and return false if the limit is exceeded; the bytes stay
    // counted.
    [[nodiscard]] bool add(std::uint64_t bytes);
    [[nodiscard]] bool begin_sweep();
    // Begins a piece that may continue a sweep counted before.
    void continue_sweep();
    [[nodiscard]] bool add_radials(std::size_t count);
    // Counts rows of at least `gates` gates for kind number `moment` of the sweep.
    [[nodiscard]] bool widen(std::size_t moment, std::size_t gates, std::uint64_t bytes_per_code);

    [[nodiscard]] std::uint64_t taken_bytes() const { return closed_bytes_ + sweep_bytes(); }
    [[nodiscard]] std::uint64_t left_bytes() const;
    void set_limit(std::uint64_t limit_bytes) { limit_bytes_ = limit_bytes; }
    // Requests the new limit now. Returns false if there is no more room; without a `More`, returns
    // true and changes nothing.
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
    std::uint64_t closed_bytes_ = 0;  // of everything except the newest sweep
    std::uint64_t radials_ = 0;       // of the newest sweep
    std::uint64_t row_bytes_ = sizeof(Radial);
    std::uint64_t kind_bytes_ = 0;
    std::vector<std::size_t> gates_;  // gates in a row, for each kind of the newest sweep
};

}  // namespace stormcellar::level2
