// bunzip/run_expander.h -- reverses the first step of bzip2, in which a byte after four equal bytes
// says how many more of them there are.
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
    // Begins a block, which is all bytes but the last. The last byte is the one that follows the
    // block when it is read as a ring. If a block ends with four equal bytes, libbz2 takes that
    // byte for the count, and the block is then bad. This class does the same.
    void begin(std::span<const std::uint8_t> bytes_and_one_more, Path path);
    // Fills `out` as far as the block reaches.
    [[nodiscard]] std::size_t read(std::span<std::uint8_t> out);
    // Returns true if nothing is left.
    [[nodiscard]] bool ended() const { return at_ >= end_ && fill_left_ == 0; }
    // Returns true if the block ended where a count was due.
    [[nodiscard]] bool bad() const { return at_ > end_; }

    struct Place {
        const std::uint8_t* from;  // the next byte to read
        std::uint8_t* to;          // the next place to write
    };
    // Expands the bytes before `end` if there is room for them up to `to_end`, and stops before
    // anything that needs care. It may read up to `slack` bytes after the place where it stops.
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
