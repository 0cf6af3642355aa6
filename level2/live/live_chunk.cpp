#include "stormcellar/level2/live_chunk.h"

#include <algorithm>
#include <utility>

#include "base/checksum.h"
#include "base/memory.h"
#include "level2/containers/archive_header.h"
#include "level2/containers/content.h"
#include "level2/containers/ldm_framer.h"
#include "level2/decode/message_reader.h"
#include "level2/decode/part_decoder.h"
#include "stormcellar/level2/live_sweep.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t rows_of_a_chunk = 120;
// A chunk usually has one record. A file of a whole volume has some hundreds.
constexpr std::size_t most_records = 1000;
constexpr std::uint64_t bytes_of_a_problem = 256;

// Returns the bytes of a fragment in memory. array_bytes counts only the rows of the first piece,
// because that piece may continue a sweep; this function adds the rest of the piece.
std::uint64_t held_bytes(const Fragment& fragment) {
    std::uint64_t bytes = fragment.array_bytes + sizeof(Fragment) +
                          fragment.report.problems.size() * bytes_of_a_problem;
    if (!fragment.pieces.empty()) {
        const std::size_t kinds = fragment.pieces.front().sweep.moments.size();
        bytes += empty_sweep_bytes + kinds * empty_kind_bytes;
    }
    return bytes;
}

bool holds_messages(const DecodeReport& report) {
    return std::any_of(report.message_counts.begin(), report.message_counts.end(),
                       [](const auto& count) { return count.first != 0; });
}

// Decodes the fragments of one chunk within the given room.
class ChunkReader {
  public:
    ChunkReader(const DecodeOptions& options, LiveRoom room) : options_(options), room_(room) {}

    Status read_records(std::span<const std::byte> body);
    Status read_messages(std::span<const std::byte> body);
    LiveChunk take() { return std::move(chunk_); }

  private:
    Status keep(Fragment fragment);

    const DecodeOptions& options_;
    LiveRoom room_;
    LiveChunk chunk_;
};

Status ChunkReader::keep(Fragment fragment) {
    if (fragment.failure == Fragment::Failure::no_memory) return no_memory();
    chunk_.output_bytes += fragment.output_bytes;
    chunk_.held_bytes += held_bytes(fragment);
    if (fragment.failure != Fragment::Failure::none || chunk_.output_bytes > room_.output_bytes ||
        chunk_.held_bytes > room_.held_bytes) {
        return fail(ErrorCode::unsupported, "the chunks take more than the limit of {} bytes",
                    options_.output_limit_bytes);
    }
    for (const Fragment::Piece& piece : fragment.pieces) {
        chunk_.radials += piece.sweep.radials.size();
        const RadialStatus last = status_of(piece.sweep.radials.back());
        chunk_.ended_volume = chunk_.ended_volume || last == RadialStatus::end_of_volume;
    }
    chunk_.fragments.push_back(std::move(fragment));
    return {};
}

Status ChunkReader::read_records(std::span<const std::byte> body) {
    PartDecoder decoder{options_.output_limit_bytes, options_.selection};
    LdmFramer framer{body};
    while (const auto part = framer.next()) {
        if (chunk_.fragments.size() == most_records) {
            return fail(ErrorCode::unsupported, "the chunk has more than {} LDM records",
                        most_records);
        }
        if (part->kind == LdmPart::Kind::record) chunk_.negative = part->negative;
        const std::uint64_t left = room_.held_bytes - chunk_.held_bytes;
        if (Status kept = keep(decoder.decode(*part, ArrayRoom{left})); !kept) return kept;
    }
    return {};
}

Status ChunkReader::read_messages(std::span<const std::byte> body) {
    ArrayRoom room{room_.held_bytes};
    FragmentBuilder builder{room, rows_of_a_chunk, options_.selection};
    MessageReader reader{builder};
    (void)reader.read(body, true);
    Fragment fragment = builder.take();
    fragment.output_bytes += body.size();
    fragment.failure = reader.failure();
    return keep(std::move(fragment));
}

}  // namespace

void put_aside(LiveChunk& chunk, SweepDepot& depot) {
    for (Fragment& fragment : chunk.fragments) {
        for (Fragment::Piece& piece : fragment.pieces) {
            Sweep& sweep = piece.sweep;
            auto& place = chunk.places.emplace_back();
            if (piece.left_out || sweep.radials.size() < 3) continue;
            place = depot.put(sweep);
            if (!place) continue;
            chunk.away_bytes += bytes_of(sweep);
            free_array(sweep.moments);
            sweep.radials = std::vector<Radial>{sweep.radials.front(), sweep.radials.back()};
        }
    }
    chunk.away_bytes = std::min(chunk.away_bytes, chunk.held_bytes);
}

Result<Sweep> whole_piece(const LiveChunk& chunk, std::size_t place, const Fragment::Piece& piece,
                          const SweepDepot* depot) {
    if (place >= chunk.places.size() || !chunk.places[place]) return piece.sweep;
    return depot->get(*chunk.places[place]);
}

Status bring_back(LiveChunk& chunk, const SweepDepot* depot) {
    std::size_t place = 0;
    for (Fragment& fragment : chunk.fragments) {
        for (Fragment::Piece& piece : fragment.pieces) {
            const std::size_t own = place++;
            if (own >= chunk.places.size() || !chunk.places[own]) continue;
            Result<Sweep> sweep = depot->get(*chunk.places[own]);
            if (!sweep) return pass_on(sweep);
            piece.sweep = std::move(*sweep);
        }
    }
    chunk.places.clear();
    chunk.away_bytes = 0;
    return {};
}

Result<LiveChunk> read_live_chunk(std::span<const std::byte> bytes, const DecodeOptions& options,
                                  LiveRoom room) {
    if (bytes.empty()) return fail(ErrorCode::empty, "the chunk is empty");
    const Content content = content_anywhere(bytes);
    auto header = read_archive_header(bytes);
    const auto body = bytes.subspan(header ? archive_header_bytes : 0);
    // Unknown content after a header may be the first bytes of a record. The header alone
    // identifies its volume.
    const bool has_records = content == Content::ldm || (content == Content::unknown && header);
    if (!has_records && content != Content::messages) {
        return fail(ErrorCode::not_level2, "not a chunk of a Level II volume");
    }
    ChunkReader reader{options, room};
    Status read = has_records ? reader.read_records(body) : reader.read_messages(body);
    if (!read) return pass_on(read);
    LiveChunk chunk = reader.take();
    bool anything = header.has_value();
    bool is_cut = false;
    for (const Fragment& fragment : chunk.fragments) {
        anything = anything || holds_messages(fragment.report);
        is_cut = is_cut || fragment.cut;
    }
    if (!anything) {
        return fail(is_cut ? ErrorCode::truncated : ErrorCode::corrupt,
                    "no part of the chunk is intact");
    }
    chunk.header = std::move(header);
    chunk.has_records = has_records;
    chunk.bytes = bytes.size();
    chunk.checksum = xxh3_64(bytes);
    return chunk;
}

}  // namespace stormcellar::level2
