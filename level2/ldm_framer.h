// level2/ldm_framer.h -- cuts a file into LDM records (ICD 2620010, section 3.3).
//
// A record is a signed 4-byte length, whose sign marks the last record as a rule, and a bzip2
// stream. Lengths that contradict the bytes are not believed: the next stream is searched for.
// Thread contract: one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "level2/volume.h"

namespace stormcellar::level2 {

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

class LdmFramer {
  public:
    explicit LdmFramer(std::span<const std::byte> bytes);
    [[nodiscard]] std::optional<LdmPart> next();

  private:
    [[nodiscard]] LdmPart record(std::span<const std::byte> rest);
    [[nodiscard]] bool may_begin_at(std::size_t position) const;

    std::span<const std::byte> bytes_;
    std::size_t zeros_from_;  // nothing but zeros from here to the end
    std::size_t at_ = 0;
};

// Whether an LDM record begins with these bytes.
[[nodiscard]] bool is_ldm_record(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
