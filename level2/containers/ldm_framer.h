// level2/containers/ldm_framer.h -- cuts a file into LDM records (ICD 2620010, section 7.3.4).
//
// A record is a signed 4-byte length, which is usually negative in the last record, and a bzip2
// stream. If a length contradicts the bytes, the framer ignores it and searches for the next
// stream.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// The longest record. The framer ignores a larger length at once, without waiting for so many
// bytes. The largest known volume has 12 MB.
inline constexpr std::size_t longest_record_bytes = std::size_t{32} << 20;

struct LdmPart {
    enum class Kind : std::uint8_t {
        record,   // `bytes` is a bzip2 stream, maybe with other bytes after it
        header,   // a 24-byte volume header between records
        padding,  // zeros before the next record or the end
        garbage   // `bytes` belong to no record
    };
    Kind kind = Kind::record;
    std::size_t position = 0;  // of the part, counted from the first byte given to the framer
    std::span<const std::byte> bytes;
    VolumeHeader header;
    bool negative = false;    // the control word of a record is negative
    bool cut = false;         // the file ends before the record does
    bool bad_length = false;  // the control word contradicts the bytes
};

// Cuts a file that grows. It waits for more bytes if they could change its decision, with one
// exception: it accepts a record at once if a bzip2 stream ends where the length says.
class LdmStreamFramer {
  public:
    // Returns the next part, or none if more bytes are needed, or at the end. `rest` holds the
    // bytes from position() on that have come so far. `last` means that no more will come. `bytes`
    // of the part points into `rest`.
    [[nodiscard]] std::optional<LdmPart> next(std::span<const std::byte> rest, bool last);
    [[nodiscard]] std::size_t position() const { return at_; }

  private:
    [[nodiscard]] std::optional<LdmPart> record(std::span<const std::byte> rest, bool last);
    [[nodiscard]] std::optional<LdmPart> record_without_length(std::span<const std::byte> rest,
                                                               std::size_t stream, bool last);
    [[nodiscard]] std::optional<std::size_t> find_stream(std::span<const std::byte> rest,
                                                         std::size_t from);
    void end_part(std::size_t bytes);

    std::size_t at_ = 0;
    std::size_t searched_ = 0;  // the next part has no stream in its first `searched_` bytes
    // In a record without a length, no further stream begins in the first `searched_behind_` bytes.
    std::size_t searched_behind_ = 0;
};

// Cuts a file that is complete.
class LdmFramer {
  public:
    explicit LdmFramer(std::span<const std::byte> bytes) : bytes_(bytes) {}
    [[nodiscard]] std::optional<LdmPart> next() {
        return framer_.next(bytes_.subspan(framer_.position()), true);
    }

  private:
    std::span<const std::byte> bytes_;
    LdmStreamFramer framer_;
};

// Returns true if an LDM record begins with these bytes.
[[nodiscard]] bool is_ldm_record(std::span<const std::byte> bytes);

// Returns the bzip2 streams of a file in order, including cut streams. Returns an empty list unless
// the file begins with an LDM record, with or without a volume header before it.
[[nodiscard]] std::vector<std::span<const std::byte>> ldm_records(std::span<const std::byte> file);

}  // namespace stormcellar::level2
