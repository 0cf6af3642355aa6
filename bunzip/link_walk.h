// bunzip/link_walk.h -- reads the bytes of a block along the links of its rows.
//
// A single walk waits for memory at each step, because a link gives the place of the next link,
// anywhere in 3.6 MB. So sixteen walks run side by side. First, rows spread over the block are
// marked: the link of each such row is stored elsewhere, and a bit and a number take its place.
// Each walk goes from a marked row to the next marked row that it meets, and then begins again at
// another marked row. These walks read the segments of the block; the marks, followed from the
// origin, give the order of the segments. docs/bunzip.md has a drawing and a proof.
//
// Each walk has room for an eighth of the block and 8 KiB. If that is too little, a single walk
// reads the block, as in libbz2. Only a stream made for this purpose needs more room. The marks are
// at uneven distances, because evenly spaced marks would be close together along the links if the
// data have a period.
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
    // Fills `bytes` with the bytes along the links from row `origin` on. The links form rings, so
    // `bytes` may be larger than `rows`. `links` holds the links of `rows` rows, which must be all
    // different and below `rows`, and room for one more link. When read() returns, the links of the
    // rows are unchanged.
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
        Link link = 0;          // the link that the mark replaced
        std::uint32_t lane = 0, begin = 0, length = 0;
        std::uint32_t next = 0;  // the segment after this one in the block
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
