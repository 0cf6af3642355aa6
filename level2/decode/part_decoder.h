// level2/decode/part_decoder.h -- makes a Fragment from an LDM record, or from the bytes between
// two records.
//
// A record is decompressed and read in small pieces, so memory never holds all its messages. If its
// checksum is wrong, the decoder discards the result and reads the record again, block by block, to
// keep the intact blocks. A block is held as a whole and may be large, so the decoder first asks
// for all the room that the fragment may get.
//
// Threads   One thread at a time; each thread has its own decoder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "bunzip/bunzip.h"
#include "level2/containers/ldm_framer.h"
#include "level2/decode/array_room.h"
#include "stormcellar/level2/fragment.h"
#include "stormcellar/level2/selection.h"

namespace stormcellar::level2 {

class PartDecoder {
  public:
    // The selection must outlive the decoder.
    PartDecoder(std::uint64_t output_limit_bytes, const Selection& selection)
        : limit_bytes_(output_limit_bytes), selection_(selection) {}

    // Decodes a part. The arrays of the fragment stay within `room`. Fragment::failure reports a
    // lack of memory; the function does not throw std::bad_alloc.
    [[nodiscard]] Fragment decode(const LdmPart& part, ArrayRoom room);
    [[nodiscard]] Fragment decode(const LdmPart& part) {
        return decode(part, ArrayRoom{limit_bytes_});
    }

  private:
    [[nodiscard]] Fragment decode_kind(const LdmPart& part, ArrayRoom& room);
    [[nodiscard]] Fragment decode_record(const LdmPart& part, ArrayRoom& room);
    struct Damage {
        bool is_cut = false;             // the end of the record is missing
        std::uint64_t wasted_bytes = 0;  // see BzipBlocks::Block
    };
    // Returns none if the record is damaged.
    [[nodiscard]] std::optional<Fragment> read_record(const LdmPart& part, ArrayRoom& room,
                                                      Damage& damage);
    [[nodiscard]] Fragment read_blocks(const LdmPart& part, ArrayRoom& room, const Damage& damage);

    std::uint64_t limit_bytes_;
    const Selection& selection_;
    std::vector<std::byte> buffer_;
    bunzip::Workspace workspace_;
};

// Returns the CPU time of the calling thread.
[[nodiscard]] double thread_cpu_s();

}  // namespace stormcellar::level2
