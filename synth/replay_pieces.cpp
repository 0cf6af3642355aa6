#include "synth/replay_pieces.h"

#include "level2/containers/archive_header.h"
#include "level2/containers/ldm_framer.h"

namespace stormcellar::synth {
namespace {

using Kind = level2::LdmPart::Kind;

constexpr std::size_t pieces_without_records = 16;

std::vector<std::size_t> sixteenths(std::size_t size) {
    std::vector<std::size_t> ends;
    for (std::size_t i = 1; i < pieces_without_records; ++i) {
        const std::size_t end = size * i / pieces_without_records;
        if (end > 0 && (ends.empty() || end > ends.back())) ends.push_back(end);
    }
    return ends;
}

}  // namespace

bool has_ldm_records(std::span<const std::byte> bytes) {
    const bool header = level2::read_archive_header(bytes).has_value();
    return level2::is_ldm_record(bytes.subspan(header ? level2::archive_header_bytes : 0));
}

std::vector<std::size_t> piece_ends(std::span<const std::byte> bytes) {
    std::vector<std::size_t> ends;
    if (has_ldm_records(bytes)) {
        level2::LdmFramer framer(bytes);
        bool record_seen = false, header_waits = false;
        while (const auto part = framer.next()) {
            if (part->kind != Kind::record && part->kind != Kind::header) continue;
            // End the previous piece before a header, because the header belongs to the record
            // after it.
            if (record_seen && !header_waits) ends.push_back(part->position);
            header_waits = part->kind == Kind::header;
            record_seen = record_seen || part->kind == Kind::record;
        }
    } else {
        ends = sixteenths(bytes.size());
    }
    if (ends.empty() || ends.back() < bytes.size()) ends.push_back(bytes.size());
    return ends;
}

bool ends_volume(std::span<const std::byte> bytes) {
    bool negative = false;
    level2::LdmFramer framer(bytes);
    while (const auto part = framer.next()) {
        if (part->kind == Kind::record) negative = part->negative;
    }
    return negative;
}

}  // namespace stormcellar::synth
