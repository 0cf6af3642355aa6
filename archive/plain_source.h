// archive/plain_source.h -- gives libarchive the bytes of a file, and bounds the bytes of headers.
//
// Only the archive room uses this.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "archive/packed_stream.h"

namespace stormcellar::archive {

class PlainSource {
  public:
    // Reads bytes from offset `at` on, at most as many as `into` holds. Returns their number, or a
    // negative number if they cannot be read.
    using ReadAt = std::function<std::int64_t(std::uint64_t at, std::span<std::byte> into)>;
    PlainSource(ReadAt read_at, std::uint64_t size, ReadBudget& header);

    // Lets `handle`, which must end before this object, read the bytes. Returns false if libarchive
    // refuses them.
    [[nodiscard]] bool feed(::archive* handle);
    // Returns true if a read has failed.
    [[nodiscard]] bool has_failed() const { return has_failed_; }

  private:
    std::int64_t read_more(::archive* handle, const void** bytes);
    std::int64_t skip(std::int64_t bytes);
    std::int64_t seek(std::int64_t offset, int whence);

    ReadAt read_at_;
    std::uint64_t size_;
    ReadBudget& header_;
    std::uint64_t at_ = 0;
    bool has_failed_ = false;
    std::vector<std::byte> block_;
};

}  // namespace stormcellar::archive
