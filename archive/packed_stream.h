// archive/packed_stream.h -- unpacks the bytes of a packed archive and counts each of them.
//
// Only the archive room uses this. libarchive skips members by unpacking them and counts nothing
// meanwhile; here every unpacked byte is checked against a bound. An archive that is packed twice
// is not accepted, because only one layer is unpacked.
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

// Counts the bytes that libarchive reads while it looks for the next header. libarchive keeps the
// contents of a header (the map of a sparse file takes twelve times its size, the directory of a
// zip three times) before anybody sees it, so they can only be bounded here. The source gives its
// bytes in small blocks, because a block counts as a whole. Only time bounds everything else that
// libarchive reads: one call may unpack gigabytes just to skip them.
class ReadBudget {
  public:
    void set_deadline(SteadyTime deadline) { deadline_ = deadline; }
    void begin(std::uint64_t most) {
        left_ = most;
        counts_ = true;
    }
    void end() { counts_ = false; }
    // Counts a header that was read. Many long headers take as much time as one longer header.
    void add(std::uint64_t bytes);
    // Returns false, and sets the handle's error, if a header is longer than it may be or the
    // deadline has passed.
    [[nodiscard]] bool take(::archive* handle, std::uint64_t bytes);
    [[nodiscard]] bool is_spent() const { return is_spent_; }
    [[nodiscard]] bool is_late() const { return is_late_; }

  private:
    std::uint64_t left_ = 0;
    std::uint64_t long_bytes_ = 0;  // of all headers, beyond the usual length
    SteadyTime deadline_ = SteadyTime::max();
    bool counts_ = false;
    bool is_spent_ = false;
    bool is_late_ = false;
};

struct CloseArchive {
    void operator()(::archive* archive) const;
};
using Handle = std::unique_ptr<::archive, CloseArchive>;

// Returns libarchive's own message for an error.
[[nodiscard]] std::string error_text_of(::archive* handle);

// Returns true if these first bytes are those of a known codec.
[[nodiscard]] bool is_packed(std::span<const std::byte> start);

class PackedStream {
  public:
    // Opens a reader on the packed bytes. It is closed with the stream.
    using OpenSource = std::function<bool(::archive* handle)>;
    // Returns how many bytes may be unpacked after this many bytes of the source were read.
    using Bound = std::function<std::uint64_t(std::uint64_t source_bytes)>;

    // Opens a stream on a source with this start. Returns none if no known codec packed it.
    // `small_codecs` allows gzip, bzip2 and compress, which take a few megabytes of memory whatever
    // the input claims; without it, xz and zstd are allowed too (up to 1 GiB). `of_source`, which
    // must outlive the object, limits how much is read of the source at a time, because the header
    // of a gzip file may have a name without an end.
    [[nodiscard]] static std::unique_ptr<PackedStream> open(std::span<const std::byte> start,
                                                            const OpenSource& source,
                                                            ReadBudget& of_source,
                                                            bool small_codecs, Bound bound);
    // Lets `handle`, which must end before this object, read the unpacked bytes. `header`, which
    // must outlive `handle`, counts the bytes of its headers.
    [[nodiscard]] bool feed(::archive* handle, ReadBudget& header);
    // Returns the bound in bytes if it was reached.
    [[nodiscard]] std::uint64_t met_bound() const { return met_bound_; }
    [[nodiscard]] std::uint64_t unpacked() const { return unpacked_; }
    // Returns true if the first unpacked byte is zero, which begins no archive.
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
