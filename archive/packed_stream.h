// archive/packed_stream.h -- unpacks the bytes of a packed archive, and checks their number.
//
// Only the archive room uses this. libarchive skips members of a packed archive by unpacking them,
// and does not count their bytes. A PackedStream checks the number of all unpacked bytes against a
// bound. The stream unpacks only one layer, so an archive that is packed twice is not accepted.
//
// Threads   One thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/steady_time.h"

struct archive;

namespace stormcellar::archive {

// Bounds the bytes that libarchive reads while it looks for the next header. libarchive stores the
// contents of a header before it returns the header, so only the source of the bytes can bound
// these contents. libarchive takes twelve bytes of memory for each byte of the map of a sparse
// file, and three for each byte of the directory of a zip. A block counts as a whole, so the source
// gives its bytes in small blocks. A deadline bounds everything else that libarchive reads, because
// one call may unpack gigabytes just to skip them.
class ReadBudget {
  public:
    void set_deadline(SteadyTime deadline) { deadline_ = deadline; }
    void begin(std::uint64_t most) {
        left_ = most;
        counts_ = true;
    }
    void end() { counts_ = false; }
    // Counts a header of this many bytes. If the bytes of headers beyond their first 8 KiB exceed 4
    // MiB together, the budget is spent, because many long headers may take too much time.
    void add(std::uint64_t bytes);
    // Counts a block. Returns false, and sets the error of the handle, if the header is too long or
    // the deadline has passed.
    [[nodiscard]] bool take(::archive* handle, std::uint64_t bytes);
    [[nodiscard]] bool is_spent() const { return is_spent_; }
    [[nodiscard]] bool is_late() const { return is_late_; }

  private:
    std::uint64_t left_ = 0;
    std::uint64_t long_bytes_ = 0;  // sum over all headers of their bytes beyond the usual length
    SteadyTime deadline_ = SteadyTime::max();
    bool counts_ = false;
    bool is_spent_ = false;
    bool is_late_ = false;
};

struct CloseArchive {
    void operator()(::archive* archive) const;
};
using Handle = std::unique_ptr<::archive, CloseArchive>;

// Returns libarchive's message for the last error of the handle.
[[nodiscard]] std::string error_text_of(::archive* handle);

// Returns true if a file that begins with these bytes is packed by a known codec.
[[nodiscard]] bool is_packed(std::span<const std::byte> start);

class PackedStream {
  public:
    // Lets `handle` read the packed bytes. The stream closes the handle when it ends.
    using OpenSource = std::function<bool(::archive* handle)>;
    // Returns how many bytes may be unpacked from the first `source_bytes` bytes of the source.
    using Bound = std::function<std::uint64_t(std::uint64_t source_bytes)>;

    // Opens a stream on a source that begins with `start`. Returns null if no allowed codec packed
    // the source, if the source may be compressed twice, or if the source cannot be read. With
    // `small_codecs`, only gzip, bzip2 and compress are allowed, which take a few megabytes of
    // memory whatever the input claims; otherwise xz and zstd are allowed too, which may take 1
    // GiB. `of_source`, which must outlive the object, limits how much the codec reads from the
    // source at a time, because a gzip header may contain an endless name.
    [[nodiscard]] static std::unique_ptr<PackedStream> open(std::span<const std::byte> start,
                                                            const OpenSource& source,
                                                            ReadBudget& of_source,
                                                            bool small_codecs, Bound bound);
    // Lets `handle`, which must end before this object, read the unpacked bytes. `header`, which
    // must outlive `handle`, bounds the bytes of headers. Returns false if libarchive refuses the
    // bytes.
    [[nodiscard]] bool feed(::archive* handle, ReadBudget& header);
    // Returns the bound in bytes if the output exceeded it, else 0.
    [[nodiscard]] std::uint64_t met_bound() const { return met_bound_; }
    [[nodiscard]] std::uint64_t unpacked() const { return unpacked_; }
    // Returns true if the first unpacked byte is zero. Only an empty tar, which is all zeros,
    // begins so.
    [[nodiscard]] bool begins_with_zero() const { return begins_with_zero_; }

  private:
    PackedStream(Handle source, ReadBudget& of_source, Bound bound);
    std::int64_t read_more(::archive* handle, const void** bytes);

    Handle source_;
    ReadBudget& of_source_;
    Bound bound_;
    std::vector<std::byte> block_;
    std::uint64_t unpacked_ = 0;
    std::uint64_t met_bound_ = 0;
    bool begins_with_zero_ = false;
    ReadBudget* header_ = nullptr;
};

}  // namespace stormcellar::archive
