// bunzip/link_walk.h -- the bytes of a block, read along the links of its rows.
//
// One walk waits for memory at each step: each link says only where the next one stands, anywhere
// in 3.6 MB. So the walk is begun at many rows at once. Rows spread over the block are marked (the
// mark, a bit and a number, takes the place of the link, which is kept aside); sixteen walks go
// side by side, each from its marked row to the next marked one that it meets, and then on from a
// row that none has begun at. What they read are the segments of the block; following the marks
// from the origin says their order. docs/bunzip.md has a drawing, and why this is right.
// Each walk has room for an eighth of the block and 8 KiB. Where that is too little, which takes a
// stream made to that end, the block is read by one walk alone, as libbz2 reads it. The marks do
// not stand at even distances: those of data that repeats itself would be close together then.
// Memory: 1.9 MB.
// Thread contract: one thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "bunzip/bzip2_format.h"
#include "bunzip/row_links.h"

namespace stormcellar::bunzip {

class LinkWalk {
  public:
    // The bytes from row `origin` on, as many as `bytes` takes, which may be more than there are
    // rows: the walk is a ring. `links`: of `rows` rows and of one behind them, all different and
    // below `rows`; they are as before when it returns.
    void read(std::span<Link> links, std::uint32_t rows, std::uint32_t origin,
              std::span<std::uint8_t> bytes);

    // Whether that was done by one walk.
    [[nodiscard]] bool walked_alone() const { return walked_alone_; }

    static constexpr std::uint32_t lanes = 16;
    static constexpr std::uint32_t most_segments = 1024;
    // How many rows are marked besides the origin, at most, and which is the i-th of them.
    [[nodiscard]] static std::uint32_t mark_count(std::uint32_t rows);
    [[nodiscard]] static std::uint32_t marked_row(std::uint32_t i, std::uint32_t rows);

  private:
    struct Segment {
        std::uint32_t row = 0;  // it begins at
        Link link = 0;          // of that row, which holds the mark
        std::uint32_t lane = 0, begin = 0, length = 0;
        std::uint32_t next = 0;  // the segment that follows
    };
    struct Lanes;

    void mark(std::span<Link> links, std::uint32_t rows, std::uint32_t origin);
    // False where a lane has no more room.
    [[nodiscard]] bool walk(std::span<Link> links, std::uint32_t rows);
    void end_segments(Lanes& at, std::uint32_t step);
    void join(std::span<std::uint8_t> bytes) const;

    std::array<Segment, most_segments> segments_;
    std::uint32_t segment_count_ = 0;
    bool walked_alone_ = false;
    std::unique_ptr<std::uint8_t[]> lane_bytes_;  // lane behind lane
};

}  // namespace stormcellar::bunzip
