// bunzip/block_decoder.h -- decodes one block: reads its tables and symbols, and reverses the sort
// of its rows.
//
// Memory    10.2 MB at most.
// Threads   One thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "bunzip/bit_reader.h"
#include "bunzip/block_tables.h"
#include "bunzip/byte_runs.h"
#include "bunzip/bzip2_format.h"
#include "bunzip/link_walk.h"
#include "bunzip/paths.h"
#include "bunzip/row_links.h"

namespace stormcellar::bunzip {

class BlockDecoder {
  public:
    BlockDecoder();
    // Reads a block from the place after its mark and checksum. The block may have up to
    // `most_bytes` rows. If the result is not good, the reader's position has no meaning.
    [[nodiscard]] Found read(BitReader& reader, std::uint32_t most_bytes, Path path);
    // Returns the bytes of the last block and one more byte, for RunExpander::begin(). Returns an
    // empty span if the block was not good.
    [[nodiscard]] std::span<const std::uint8_t> bytes_and_one_more() const { return bytes_; }

  private:
    [[nodiscard]] Found read_runs(BitReader& reader, std::uint32_t most_bytes, Path path);

    BlockTables tables_;
    RunMaker maker_;
    std::unique_ptr<ByteRun[]> runs_;
    std::size_t run_count_ = 0;
    std::unique_ptr<Link[]> links_;
    LinkWalk walk_;
    std::unique_ptr<std::uint8_t[]> room_;
    std::span<const std::uint8_t> bytes_;
};

}  // namespace stormcellar::bunzip
