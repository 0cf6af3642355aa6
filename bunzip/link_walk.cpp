#include "bunzip/link_walk.h"

#include <algorithm>
#include <cstring>

namespace stormcellar::bunzip {
namespace {

constexpr Link marked = Link{1} << 31;
// Segments have at least this many rows on average. Shorter segments would gain little.
constexpr std::uint32_t rows_a_segment = 256;
constexpr std::uint32_t spare_room = 8192;
// With this stride, the lanes write the bytes of one step to different sets of the cache.
constexpr std::size_t lane_stride = (most_rows / 8 + spare_room) / 4096 * 4096 + 4096 + 5 * 64;
static_assert(LinkWalk::most_segments < marked && (most_rows + 1) << link_shift < marked);

}  // namespace

// The next link of each lane, and the segment that the lane reads. A lane without a segment stays
// on the row after the last row, which links to itself.
struct LinkWalk::Lanes {
    Link idle;
    std::array<Link, lanes> link;  // link of the row that is read next
    std::array<std::uint32_t, lanes> segment{};
    std::uint32_t begun = 0;  // number of segments that were begun
    std::uint32_t busy = 0;   // number of lanes with a segment
};

std::uint32_t LinkWalk::mark_count(std::uint32_t rows) {
    return std::min(most_segments - 1, rows / rows_a_segment);
}

// Returns the i-th marked row. Each mark is in one of mark_count() equal pieces of the block.
// Multiples of the golden ratio give the place of the mark in its piece, so that the marks follow
// no period in the data.
std::uint32_t LinkWalk::marked_row(std::uint32_t i, std::uint32_t rows) {
    const std::uint64_t count = mark_count(rows);
    const std::uint64_t begin = rows * std::uint64_t{i} / count;
    const std::uint64_t end = rows * (std::uint64_t{i} + 1) / count;
    const std::uint32_t share = i * 0x9E37'79B9U;
    return static_cast<std::uint32_t>(begin + ((end - begin) * share >> 32));
}

// Marks the rows at which segments begin. A mark replaces the link of the row; the segment stores
// the link.
void LinkWalk::mark(std::span<Link> links, std::uint32_t rows, std::uint32_t origin) {
    segment_count_ = 0;
    const auto add = [&](std::uint32_t row) {
        Segment& segment = segments_[segment_count_];
        segment.row = row;
        segment.link = links[row];
        links[row] = marked | segment_count_++;
    };
    add(origin);
    const std::uint32_t count = mark_count(rows);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t row = marked_row(i, rows);
        if (row != origin) add(row);
    }
}

// Ends the segment of each lane that met a mark, and begins the next segment in that lane.
void LinkWalk::end_segments(Lanes& at, std::uint32_t step) {
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        if ((at.link[lane] & marked) == 0) continue;
        Segment& ended = segments_[at.segment[lane]];
        ended.length = step - ended.begin;
        ended.next = at.link[lane] & ~marked;
        if (at.begun < segment_count_) {
            Segment& begun = segments_[at.begun];
            begun.lane = lane;
            begun.begin = step;
            at.segment[lane] = at.begun++;
            at.link[lane] = begun.link;
        } else {
            at.link[lane] = at.idle;
            --at.busy;
        }
    }
}

// Walks along the links with all lanes at once. For each lane, the inner loop only writes a byte
// and reads the next link; it stops when any lane has met a mark. The loads of the lanes do not
// depend on each other, so the processor waits for all of them together. Returns false if a lane
// has no room left.
bool LinkWalk::walk(std::span<Link> links, std::uint32_t rows) {
    Lanes at{rows << link_shift, {}};
    links[rows] = at.idle;
    at.link.fill(at.idle);
    for (std::uint32_t lane = 0; lane < lanes; ++lane) {
        if (at.begun == segment_count_) continue;
        Segment& segment = segments_[at.begun];
        segment.lane = lane;
        segment.begin = 0;
        at.segment[lane] = at.begun++;
        at.link[lane] = segment.link;
        ++at.busy;
    }
    const Link* const table = links.data();
    std::uint8_t* const bytes = lane_bytes_.get();
    const std::uint32_t room = rows / 8 + spare_room;
    std::uint32_t step = 0;
    while (at.busy > 0) {
        if (step == room) return false;
        Link link[lanes];
        std::copy(at.link.begin(), at.link.end(), link);
        Link met = 0;
        do {
            met = 0;
            for (std::uint32_t lane = 0; lane < lanes; ++lane) {
                bytes[lane * lane_stride + step] = static_cast<std::uint8_t>(link[lane]);
                link[lane] = table[link[lane] >> link_shift];
                met |= link[lane];
            }
            ++step;
        } while ((met & marked) == 0 && step < room);
        std::copy(std::begin(link), std::end(link), at.link.begin());
        end_segments(at, step);
    }
    return true;
}

// Copies the segments from the lanes into the order of the block, by following the marks from the
// origin.
void LinkWalk::join(std::span<std::uint8_t> bytes) const {
    std::size_t done = 0;
    for (std::uint32_t i = 0; done < bytes.size(); i = segments_[i].next) {
        const Segment& segment = segments_[i];
        const std::size_t piece = std::min<std::size_t>(segment.length, bytes.size() - done);
        std::memcpy(bytes.data() + done,
                    lane_bytes_.get() + segment.lane * lane_stride + segment.begin, piece);
        done += piece;
    }
}

void LinkWalk::read(std::span<Link> links, std::uint32_t rows, std::uint32_t origin,
                    std::span<std::uint8_t> bytes) {
    if (!lane_bytes_)
        lane_bytes_ = std::make_unique_for_overwrite<std::uint8_t[]>(lanes * lane_stride);
    mark(links, rows, origin);
    walked_alone_ = !walk(links, rows);
    for (std::uint32_t i = 0; i < segment_count_; ++i)
        links[segments_[i].row] = segments_[i].link;
    if (!walked_alone_) return join(bytes);
    // The lanes had too little room, so read the block with a single walk.
    Link link = links[origin];
    for (std::uint8_t& byte : bytes) {
        byte = static_cast<std::uint8_t>(link);
        link = links[link >> link_shift];
    }
}

}  // namespace stormcellar::bunzip
