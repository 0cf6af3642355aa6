// level2/containers/ldm_framer.h -- cuts a file into LDM records (ICD 2620010, section 7.3.4).
//
// A record is a signed 4-byte length, whose sign marks the last record as a rule, and a bzip2
// stream. Lengths that contradict the bytes are not believed: the next stream is searched for.
// Thread contract: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// The largest volume known, all of it, has 12 MB. A length beyond this is a lie, and is known to be
// one before so many bytes have come.
inline constexpr std::size_t longest_record_bytes = std::size_t{32} << 20;

struct LdmPart {
    enum class Kind : std::uint8_t {
        record,   // `bytes` is a bzip2 stream, maybe with something behind it
        header,   // a 24-byte volume header between records
        padding,  // zeros up to the end
        garbage   // `bytes` belong to no record
    };
    Kind kind = Kind::record;
    std::size_t position = 0;  // of the part in the file
    std::span<const std::byte> bytes;
    VolumeHeader header;
    bool negative = false;    // the control word of a record
    bool cut = false;         // the file ends before the record does
    bool bad_length = false;  // the control word contradicts the bytes
};

// Cuts what grows. Decides nothing that later bytes could change, except that a record whose
// length ends at the end mark of a bzip2 stream is taken at once.
class LdmStreamFramer {
  public:
    // `rest`: the bytes from position() on, as far as there are any yet; `last`: there will be no
    // more. None when more are needed, or at the end. The part's bytes lie in `rest`.
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
    std::size_t searched_ = 0;         // no stream begins in so many bytes of the part that is due
    std::size_t searched_behind_ = 0;  // nor, behind its own, of one without a length
};

// Cuts what is there as a whole.
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

// Whether an LDM record begins with these bytes.
[[nodiscard]] bool is_ldm_record(std::span<const std::byte> bytes);

// The bzip2 streams of a file, in its order, cut ones included; none where the file does not begin
// with an LDM record, behind a volume header or at once.
[[nodiscard]] std::vector<std::span<const std::byte>> ldm_records(std::span<const std::byte> file);

}  // namespace stormcellar::level2
