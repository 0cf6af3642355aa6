#include "level2/ldm_framer.h"

#include <algorithm>

#include "base/byte_reader.h"
#include "level2/archive_header.h"
#include "level2/bzip2_stream.h"
#include "level2/message_header.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t control_word_bytes = 4;

}  // namespace

bool is_ldm_record(std::span<const std::byte> bytes) {
    return bytes.size() > control_word_bytes && is_bzip2(bytes.subspan(control_word_bytes));
}

LdmFramer::LdmFramer(std::span<const std::byte> bytes) : bytes_(bytes), zeros_from_(bytes.size()) {
    while (zeros_from_ > 0 && bytes_[zeros_from_ - 1] == std::byte{0})
        --zeros_from_;
}

bool LdmFramer::may_begin_at(std::size_t position) const {
    const auto rest = bytes_.subspan(position);
    if (rest.size() < control_word_bytes + bzip2_mark_bytes) return true;  // a tail, or the end
    return is_ldm_record(rest) || read_archive_header(rest) || position >= zeros_from_;
}

LdmPart LdmFramer::record(std::span<const std::byte> rest) {
    ByteReader reader{rest};
    const std::int64_t control = reader.i32();
    LdmPart part;
    part.kind = LdmPart::Kind::record;
    part.position = at_;
    part.negative = control < 0;
    const auto length = static_cast<std::size_t>(control < 0 ? -control : control);
    const auto stream = rest.subspan(control_word_bytes);
    if (length <= stream.size() && may_begin_at(at_ + control_word_bytes + length)) {
        part.bytes = stream.first(length);
        at_ += control_word_bytes + length;
        return part;
    }
    // The length lies, or the file is cut: the record reaches to the next one or to the end.
    const auto next = find_bzip2(stream, bzip2_mark_bytes + control_word_bytes);
    part.bytes = next ? stream.first(*next - control_word_bytes) : stream;
    part.cut = !next && length > stream.size();
    part.bad_length = !part.cut;
    at_ += control_word_bytes + part.bytes.size();
    return part;
}

std::optional<LdmPart> LdmFramer::next() {
    if (at_ >= bytes_.size()) return std::nullopt;
    const auto rest = bytes_.subspan(at_);
    LdmPart part;
    part.position = at_;
    if (auto header = read_archive_header(rest)) {
        part.kind = LdmPart::Kind::header;
        part.header = std::move(*header);
        at_ += archive_header_bytes;
        return part;
    }
    if (is_ldm_record(rest)) return record(rest);
    const auto stream = find_bzip2(rest, control_word_bytes + 1);
    part.bytes = stream ? rest.first(*stream - control_word_bytes) : rest;
    part.kind = all_zero(part.bytes) ? LdmPart::Kind::padding : LdmPart::Kind::garbage;
    at_ += part.bytes.size();
    return part;
}

}  // namespace stormcellar::level2
