// bunzip/run_expander.h -- undoes the first step of bzip2: four equal bytes are followed by one
// that says how many more there are.
//
// Thread contract: one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "bunzip/paths.h"

namespace stormcellar::bunzip {

class RunExpander {
  public:
    // Of all of them but the last is the block's; the last follows it when the block is read as a
    // ring. libbz2 takes it for the count where a block ends in four equal bytes, and the block is
    // then bad, so that is done here too.
    void begin(std::span<const std::uint8_t> bytes_and_one_more, Path path);
    // Fills `out` as far as the block goes.
    [[nodiscard]] std::size_t read(std::span<std::uint8_t> out);
    // Nothing is left.
    [[nodiscard]] bool ended() const { return at_ >= end_ && fill_left_ == 0; }
    // The block ended where a count was due.
    [[nodiscard]] bool bad() const { return at_ > end_; }

    struct Place {
        const std::uint8_t* from;  // what is read next
        std::uint8_t* to;          // what is written next
    };
    // Expands what stands before `end`, where there is room for it up to `to_end`, and stops before
    // what needs care. It may read up to `slack` bytes behind where it stops.
    using Expand = Place (*)(Place place, const std::uint8_t* end, const std::uint8_t* to_end);

  private:
    void read_careful(std::span<std::uint8_t> out, std::size_t& made);

    const std::uint8_t* at_ = nullptr;
    const std::uint8_t* end_ = nullptr;
    Expand expand_ = nullptr;
    std::uint32_t fill_left_ = 0;
    std::uint8_t fill_byte_ = 0;
    unsigned equal_ = 0;  // bytes before at_ that are alike, 0 to 3, in the careful reading
};

}  // namespace stormcellar::bunzip
