// bunzip/run_expander.h -- reverses the first step of bzip2, in which a byte after four equal bytes
// gives the number of further equal bytes.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bunzip/paths.h"

namespace stormcellar::bunzip {

class RunExpander {
  public:
    // Begins a block. The argument holds the bytes of the block, and one more byte, which follows
    // when the block is read as a ring. If the block ends with four equal bytes, this class takes
    // the additional byte as the count, as libbz2 does, and the block is bad.
    void begin(std::span<const std::uint8_t> bytes_and_one_more, Path path);
    // Fills `out` unless the block ends, and returns the number of bytes.
    [[nodiscard]] std::size_t read(std::span<std::uint8_t> out);
    // Returns true if nothing is left.
    [[nodiscard]] bool ended() const { return at_ >= end_ && fill_left_ == 0; }
    // Returns true if the block ended before the count of a run.
    [[nodiscard]] bool bad() const { return at_ > end_; }

    struct Place {
        const std::uint8_t* from;  // the next byte to read
        std::uint8_t* to;          // the next place to write
    };
    // A kernel that expands bytes before `end` to the room before `to_end`, and returns where it
    // stopped. The kernel stops early, near the end of the bytes or of the room.
    using Expand = Place (*)(Place place, const std::uint8_t* end, const std::uint8_t* to_end);

  private:
    void read_careful(std::span<std::uint8_t> out, std::size_t& made);

    const std::uint8_t* at_ = nullptr;
    const std::uint8_t* end_ = nullptr;
    Expand expand_ = nullptr;
    std::uint32_t fill_left_ = 0;
    std::uint8_t fill_byte_ = 0;
    unsigned equal_ = 0;  // number of equal bytes before at_, 0 to 3, in read_careful()
};

}  // namespace stormcellar::bunzip
