#include "level2/containers/ldm_framer.h"

#include <algorithm>

#include "base/byte_reader.h"
#include "level2/containers/archive_header.h"
#include "level2/containers/bzip2_stream.h"
#include "level2/messages/message_header.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t control_word_bytes = 4;

// Returns true if `rest`, the bytes after a record, makes the length of that record credible.
// Returns none while there are too few bytes to decide.
std::optional<bool> may_begin(std::span<const std::byte> rest, bool last) {
    if (rest.size() < archive_header_bytes && !last) return std::nullopt;
    // a short remainder, or nothing, is credible at the end of the file
    if (rest.size() < control_word_bytes + bzip2_mark_bytes) return true;
    return is_ldm_record(rest) || read_archive_header(rest) ||
           all_zero(rest.first(control_word_bytes + bzip2_mark_bytes));
}

}  // namespace

bool is_ldm_record(std::span<const std::byte> bytes) {
    return bytes.size() > control_word_bytes && is_bzip2(bytes.subspan(control_word_bytes));
}

void LdmStreamFramer::end_part(std::size_t bytes) {
    at_ += bytes;
    searched_ = 0;
    searched_behind_ = 0;
}

// Finds the next bzip2 stream, as find_bzip2() does. A repeated search continues where the previous
// search stopped.
std::optional<std::size_t> LdmStreamFramer::find_stream(std::span<const std::byte> rest,
                                                        std::size_t from) {
    const auto found = find_bzip2(rest, std::max(from, searched_));
    if (!found) searched_ = rest.size() - std::min(rest.size(), bzip2_mark_bytes);
    return found;
}

std::optional<LdmPart> LdmStreamFramer::record(std::span<const std::byte> rest, bool last) {
    ByteReader reader{rest};
    const std::int64_t control = reader.i32();
    LdmPart part;
    part.kind = LdmPart::Kind::record;
    part.position = at_;
    part.negative = control < 0;
    const auto length = static_cast<std::size_t>(control < 0 ? -control : control);
    const auto stream = rest.subspan(control_word_bytes);
    if (length > stream.size() && length <= longest_record_bytes && !last) return std::nullopt;
    if (length <= stream.size() && length <= longest_record_bytes) {
        std::optional<bool> right = ends_as_bzip2(stream.first(length));
        if (!*right) right = may_begin(stream.subspan(length), last);
        if (!right) return std::nullopt;
        if (*right) {
            part.bytes = stream.first(length);
            end_part(control_word_bytes + length);
            return part;
        }
    }
    // The length is wrong or the file is cut, so the record extends to the next record or to the
    // end.
    const auto next = find_stream(rest, 2 * control_word_bytes + bzip2_mark_bytes);
    if (!next && !last) return std::nullopt;
    part.bytes = next ? rest.subspan(control_word_bytes, *next - 2 * control_word_bytes) : stream;
    part.cut = !next && length > stream.size() && length <= longest_record_bytes;
    part.bad_length = !part.cut;
    end_part(control_word_bytes + part.bytes.size());
    return part;
}

// Returns a record whose control word has lost bytes, so that its stream begins too early.
std::optional<LdmPart> LdmStreamFramer::record_without_length(std::span<const std::byte> rest,
                                                              std::size_t stream, bool last) {
    const std::size_t from = stream + bzip2_mark_bytes + control_word_bytes;
    const auto next = find_bzip2(rest, std::max(from, searched_behind_));
    if (!next && !last) {
        searched_behind_ = rest.size() - std::min(rest.size(), bzip2_mark_bytes);
        return std::nullopt;
    }
    LdmPart part;
    part.position = at_;
    part.bad_length = true;
    const std::size_t end = next ? *next - control_word_bytes : rest.size();
    part.bytes = rest.subspan(stream, end - stream);
    end_part(end);
    return part;
}

std::optional<LdmPart> LdmStreamFramer::next(std::span<const std::byte> rest, bool last) {
    if (rest.empty() || (rest.size() < archive_header_bytes && !last && !is_ldm_record(rest))) {
        return std::nullopt;
    }
    LdmPart part;
    part.position = at_;
    if (auto header = read_archive_header(rest)) {
        part.kind = LdmPart::Kind::header;
        part.header = std::move(*header);
        end_part(archive_header_bytes);
        return part;
    }
    if (is_ldm_record(rest)) return record(rest, last);
    const auto stream = find_stream(rest, 0);
    if (!stream && !last) return std::nullopt;
    if (stream && *stream < control_word_bytes) return record_without_length(rest, *stream, last);
    part.bytes = stream ? rest.first(*stream - control_word_bytes) : rest;
    part.kind = all_zero(part.bytes) ? LdmPart::Kind::padding : LdmPart::Kind::garbage;
    end_part(part.bytes.size());
    return part;
}

std::vector<std::span<const std::byte>> ldm_records(std::span<const std::byte> file) {
    const bool header = read_archive_header(file).has_value();
    std::vector<std::span<const std::byte>> records;
    if (!is_ldm_record(file.subspan(header ? archive_header_bytes : 0))) return records;
    LdmFramer framer(file);
    while (const auto part = framer.next()) {
        if (part->kind == LdmPart::Kind::record) records.push_back(part->bytes);
    }
    return records;
}

}  // namespace stormcellar::level2
