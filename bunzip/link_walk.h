// bunzip/link_walk.h -- reads the bytes of a block along the links of its rows.
//
// A single walk waits for memory at each step, because each link only says where the next one is,
// anywhere in 3.6 MB. So the walk begins at many rows at once. Rows spread over the block are
// marked: a mark, which is a bit and a number, replaces the link, which is kept elsewhere. Sixteen
// walks run side by side, each from its marked row to the next marked row that it meets, and then
// from another row at which no walk has begun. They read the segments of the block; the marks,
// followed from the origin, give the order of the segments. docs/bunzip.md has a drawing and a
// proof.
//
// Each walk has room for an eighth of the block and 8 KiB. If that is too little, which only a
// stream made for this purpose causes, a single walk reads the block, as in libbz2. The marks are
// not at even distances, because in data that repeats itself they would then be close together
// along the links.
//
// Memory    1.9 MB.
// Threads   One thread at a time.
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
    // Reads the bytes from row `origin` on, as many as `bytes` takes. These may be more than there
    // are rows, because the walk is a ring. `links` holds the links of `rows` rows and one more;
    // the links are all different and below `rows`. When read() returns, they are unchanged.
    void read(std::span<Link> links, std::uint32_t rows, std::uint32_t origin,
              std::span<std::uint8_t> bytes);

    // Returns true if a single walk read the block.
    [[nodiscard]] bool walked_alone() const { return walked_alone_; }

    static constexpr std::uint32_t lanes = 16;
    static constexpr std::uint32_t most_segments = 1024;
    // mark_count() returns the largest number of rows that are marked besides the origin;
    // marked_row() returns the i-th of them.
    [[nodiscard]] static std::uint32_t mark_count(std::uint32_t rows);
    [[nodiscard]] static std::uint32_t marked_row(std::uint32_t i, std::uint32_t rows);

  private:
    struct Segment {
        std::uint32_t row = 0;  // the row where it begins
        Link link = 0;          // the link of that row, which holds the mark
        std::uint32_t lane = 0, begin = 0, length = 0;
        std::uint32_t next = 0;  // the next segment
    };
    struct Lanes;

    void mark(std::span<Link> links, std::uint32_t rows, std::uint32_t origin);
    // Returns false if a lane has no room left.
    [[nodiscard]] bool walk(std::span<Link> links, std::uint32_t rows);
    void end_segments(Lanes& at, std::uint32_t step);
    void join(std::span<std::uint8_t> bytes) const;

    std::array<Segment, most_segments> segments_;
    std::uint32_t segment_count_ = 0;
    bool walked_alone_ = false;
    std::unique_ptr<std::uint8_t[]> lane_bytes_;  // the lanes, one after the other
};

}  // namespace stormcellar::bunzip
