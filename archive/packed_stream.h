// archive/packed_stream.h -- the bytes of a packed archive as they unpack, each of them counted.
//
// Inside the archive room only. libarchive passes over members by unpacking them, and counts
// nothing while it does; here every byte that comes out passes by a bound. What is packed twice
// is refused: between the two layers nobody counts. Thread contract: one thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct archive;

namespace stormcellar::archive {

struct CloseArchive {
    void operator()(::archive* archive) const;
};
using Handle = std::unique_ptr<::archive, CloseArchive>;

// libarchive's own words on what is wrong.
[[nodiscard]] std::string error_text_of(::archive* handle);

class PackedStream {
  public:
    // Opens a reader on the packed bytes; it is closed with the stream.
    using OpenSource = std::function<bool(::archive* handle)>;
    // How many bytes may come out when so many of the source were read.
    using Bound = std::function<std::uint64_t(std::uint64_t source_bytes)>;

    // None where the source is not packed once by a filter that is known. `small_codecs`: gzip,
    // bzip2 and compress, which take a few megabytes of memory whatever the input says; else xz
    // and zstd as well (up to 1 GiB).
    [[nodiscard]] static std::unique_ptr<PackedStream> open(const OpenSource& source,
                                                            bool small_codecs, Bound bound);
    // Reads `handle`, which must end before this, from what is unpacked.
    [[nodiscard]] bool feed(::archive* handle);
    // How many bytes the bound was, where it was met.
    [[nodiscard]] std::uint64_t met_bound() const { return met_bound_; }

  private:
    PackedStream(Handle source, Bound bound);
    std::int64_t read_more(::archive* handle, const void** bytes);

    Handle source_;
    Bound bound_;
    std::vector<std::byte> block_;
    std::uint64_t unpacked_ = 0;
    std::uint64_t met_bound_ = 0;
};

}  // namespace stormcellar::archive
