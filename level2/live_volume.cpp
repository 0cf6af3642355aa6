#include "level2/live_volume.h"

#include <algorithm>
#include <new>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/checksum.h"
#include "level2/archive_header.h"
#include "level2/content.h"
#include "level2/ldm_framer.h"
#include "level2/message_reader.h"
#include "level2/volume_builder.h"

namespace stormcellar::level2 {
namespace {

constexpr std::size_t rows_of_a_chunk = 120;
constexpr int largest_number = 999;  // names have three digits
// A chunk has one as a rule; a file of a whole volume has some hundreds.
constexpr std::size_t most_records = 1000;
constexpr std::uint64_t bytes_of_a_problem = 256;

LdmPart header_part(const VolumeHeader& header) {
    LdmPart part;
    part.kind = LdmPart::Kind::header;
    part.header = header;
    return part;
}

bool is_same_volume(const VolumeHeader& a, const VolumeHeader& b) {
    return std::tie(a.filename, a.date, a.ms) == std::tie(b.filename, b.date, b.ms);
}

bool holds_messages(const DecodeReport& report) {
    return std::any_of(report.message_counts.begin(), report.message_counts.end(),
                       [](const auto& count) { return count.first != 0; });
}

}  // namespace

// Beside all others, instead of the one that has its number now.
LiveVolume::Left LiveVolume::left_for(int number) const {
    const std::uint64_t limit = options_.decode.output_limit_bytes;
    Left left{limit, limit};
    for (const auto& [other_number, other] : chunks_) {
        if (other_number == number) continue;
        left.output_bytes -= std::min(left.output_bytes, other.output_bytes);
        left.held_bytes -= std::min(left.held_bytes, other.held_bytes);
    }
    return left;
}

Status LiveVolume::keep(Fragment fragment, Left left, Chunk& chunk) const {
    if (fragment.failure == Fragment::Failure::no_memory) return no_memory();
    chunk.output_bytes += fragment.output_bytes;
    chunk.held_bytes += fragment.array_bytes + sizeof(Fragment) +
                        fragment.report.problems.size() * bytes_of_a_problem;
    if (fragment.failure != Fragment::Failure::none || chunk.output_bytes > left.output_bytes ||
        chunk.held_bytes > left.held_bytes) {
        return fail(ErrorCode::unsupported, "the chunks take more than the limit of {} bytes",
                    options_.decode.output_limit_bytes);
    }
    for (const Fragment::Piece& piece : fragment.pieces) {
        chunk.radials += piece.sweep.radials.size();
        const RadialStatus last = status_of(piece.sweep.radials.back());
        chunk.ended_volume = chunk.ended_volume || last == RadialStatus::end_of_volume;
    }
    chunk.fragments.push_back(std::move(fragment));
    return {};
}

Status LiveVolume::read_records(std::span<const std::byte> body, Left left, Chunk& chunk) const {
    PartDecoder decoder{options_.decode.output_limit_bytes, options_.decode.selection};
    LdmFramer framer{body};
    while (const auto part = framer.next()) {
        if (chunk.fragments.size() == most_records) {
            return fail(ErrorCode::unsupported, "a chunk of more than {} LDM records",
                        most_records);
        }
        if (part->kind == LdmPart::Kind::record) chunk.negative = part->negative;
        Fragment fragment = decoder.decode(*part, ArrayRoom{left.held_bytes - chunk.held_bytes});
        if (Status kept = keep(std::move(fragment), left, chunk); !kept) return kept;
    }
    return {};
}

Result<LiveVolume::Chunk> LiveVolume::read_chunk(std::span<const std::byte> bytes,
                                                 Left left) const {
    if (bytes.empty()) return fail(ErrorCode::empty, "the chunk is empty");
    Chunk chunk;
    const Content content = content_anywhere(bytes);
    chunk.header = read_archive_header(bytes);
    const auto body = bytes.subspan(chunk.header ? archive_header_bytes : 0);
    // A header with the first bytes of a record tells which volume it is.
    chunk.has_records = content == Content::ldm || (content == Content::unknown && chunk.header);
    if (!chunk.has_records && content != Content::messages) {
        return fail(ErrorCode::not_level2, "not a chunk of a Level II volume");
    }
    Status read = chunk.has_records ? read_records(body, left, chunk)
                                    : keep(read_messages(body, left.held_bytes), left, chunk);
    if (!read) return pass_on(read);
    bool anything = chunk.header.has_value();
    bool is_cut = false;
    for (const Fragment& fragment : chunk.fragments) {
        anything = anything || holds_messages(fragment.report);
        is_cut = is_cut || fragment.cut;
    }
    if (!anything) {
        return fail(is_cut ? ErrorCode::truncated : ErrorCode::corrupt,
                    "nothing in the chunk is whole");
    }
    chunk.bytes = bytes.size();
    chunk.checksum = xxh3_64(bytes);
    return chunk;
}

Fragment LiveVolume::read_messages(std::span<const std::byte> bytes,
                                   std::uint64_t limit_bytes) const {
    ArrayRoom room{limit_bytes};
    FragmentBuilder builder{room, rows_of_a_chunk, options_.decode.selection};
    MessageReader reader{builder};
    (void)reader.read(bytes, true);
    Fragment fragment = builder.take();
    fragment.output_bytes = bytes.size();
    if (reader.full()) fragment.failure = Fragment::Failure::too_large_arrays;
    return fragment;
}

Result<LiveVolume::Added> LiveVolume::keep_better(int number, Chunk chunk, Clock::time_point now) {
    if (chunk.header) {
        const auto [first, is_new] = headers_.try_emplace(number, *chunk.header);
        if (!is_new && !is_same_volume(first->second, *chunk.header)) return Added::another_volume;
    }
    const auto there = chunks_.find(number);
    if (there == chunks_.end()) {
        last_arrival_ = now;
        chunk.serial = next_serial_++;
        chunks_.emplace(number, std::move(chunk));
        return Added::added;
    }
    Chunk& old = there->second;
    // A name that says that it is the last is believed, whatever another name says.
    if (chunk.kind == ChunkKind::end) old.kind = ChunkKind::end;
    if (old.bytes == chunk.bytes && old.checksum == chunk.checksum) return Added::repeated;
    const auto worth = [](const Chunk& c) { return std::tie(c.radials, c.bytes, c.checksum); };
    if (worth(chunk) < worth(old)) return Added::worse;
    last_arrival_ = now;
    chunk.serial = next_serial_++;
    if (old.kind == ChunkKind::end) chunk.kind = ChunkKind::end;
    old = std::move(chunk);
    return Added::replaced;
}

Result<LiveVolume::Added> LiveVolume::add(int number, ChunkKind kind,
                                          std::span<const std::byte> bytes, Clock::time_point now) {
    if (number < 1 || number > largest_number) {
        return fail(ErrorCode::bad_argument, "chunks are numbered from 1 to {}, not {}",
                    largest_number, number);
    }
    try {
        Result<Chunk> chunk = read_chunk(bytes, left_for(number));
        if (chunk) {
            chunk->kind = kind;
            refused_.erase(number);
            return keep_better(number, std::move(*chunk), now);
        }
        if (!chunks_.contains(number)) {
            // Of several the same one is named in any order.
            std::string& reason = refused_[number];
            if (reason.empty() || chunk.error().message < reason) reason = chunk.error().message;
        }
        return pass_on(chunk);
    } catch (const std::bad_alloc&) {
        return no_memory();
    }
}

bool LiveVolume::has_ended() const {
    return std::any_of(chunks_.begin(), chunks_.end(), [](const auto& entry) {
        const Chunk& chunk = entry.second;
        // A start chunk alone may have a negative word: its record is the last of the metadata.
        return chunk.kind == ChunkKind::end || chunk.ended_volume ||
               (chunk.negative && chunk.radials > 0);
    });
}

std::vector<int> LiveVolume::missing_numbers() const {
    std::vector<int> missing;
    int due = 1;
    for (const auto& [number, chunk] : chunks_) {
        for (; due < number; ++due)
            missing.push_back(due);
        due = number + 1;
    }
    return missing;
}

bool LiveVolume::is_due(Clock::time_point now) const {
    if (chunks_.empty()) return false;
    const auto waited = now - last_arrival_;
    if (waited >= options_.timeout) return true;
    return has_ended() && (missing_numbers().empty() || waited >= options_.grace);
}

Volume LiveVolume::facts() const {
    VolumeBuilder builder{options_.decode.output_limit_bytes};
    for (const auto& [number, chunk] : chunks_) {
        if (chunk.header && !builder.so_far().header) builder.set_header(*chunk.header);
        for (const Fragment& fragment : chunk.fragments)
            builder.note_facts(fragment);
    }
    return builder.facts(options_.decode.fallback_station);
}

// Which pieces make a sweep, by the rule of the VolumeBuilder, from piece to piece in their order.
class LiveVolume::Grouper {
  public:
    void begin_chunk(const Chunk& chunk) {
        header_between_ = header_between_ || (chunk.header && !first_chunk_);
        first_chunk_ = false;
        serial_ = chunk.serial;
        place_ = 0;
    }
    void note(const FragmentMarks& marks) {
        if (!marks.patterns.empty()) {
            pattern_ = marks.patterns.back();
            pattern_id_ = {serial_ + 1, 0};
        }
        header_between_ = header_between_ || marks.header.has_value();
    }
    void add(const Fragment::Piece& piece) {
        note(piece.before);
        const bool continues =
            previous_ != nullptr && !header_between_ && continues_sweep(*previous_, piece);
        if (!continues && !sweeps_.empty()) sweeps_.back().closed = true;
        previous_ = &piece;
        header_between_ = false;
        const PieceId id{serial_, place_++};
        if (piece.left_out) return;
        if (!continues) sweeps_.push_back({{}, {pattern_id_}, pattern_, false});
        OpenSweep& sweep = sweeps_.back();
        sweep.pieces.push_back(&piece);
        sweep.ids.push_back(id);
        sweep.closed = ends_sweep(piece.sweep.radials.back());
    }
    [[nodiscard]] std::vector<OpenSweep> take() { return std::move(sweeps_); }

  private:
    std::vector<OpenSweep> sweeps_;
    std::optional<Vcp> pattern_;
    PieceId pattern_id_{};  // the chunk that gave the pattern, if any
    const Fragment::Piece* previous_ = nullptr;
    bool header_between_ = false;
    bool first_chunk_ = true;
    std::uint64_t serial_ = 0;
    std::size_t place_ = 0;
};

std::vector<LiveVolume::OpenSweep> LiveVolume::sweeps_by_piece() const {
    Grouper grouper;
    for (const auto& [number, chunk] : chunks_) {
        grouper.begin_chunk(chunk);
        for (const Fragment& fragment : chunk.fragments) {
            for (const Fragment::Piece& piece : fragment.pieces)
                grouper.add(piece);
            grouper.note(fragment.behind);
        }
    }
    return grouper.take();
}

Sweep LiveVolume::join(const OpenSweep& open) const {
    Fragment fragment;
    for (const Fragment::Piece* piece : open.pieces) {
        fragment.pieces.push_back(*piece);
        fragment.pieces.back().before = {};
    }
    if (open.pattern) fragment.pieces.front().before.patterns = {*open.pattern};
    VolumeBuilder builder{options_.decode.output_limit_bytes};
    if (!builder.append(std::move(fragment))) return {};
    return builder.so_far().sweeps.empty() ? Sweep{} : builder.whole_sweep(0);
}

std::vector<LiveSweep> LiveVolume::changed_sweeps() {
    std::vector<LiveSweep> changed;
    std::set<std::uint64_t> handed_out;
    std::uint64_t bytes = 0;
    const std::vector<OpenSweep> sweeps = sweeps_by_piece();
    for (std::size_t i = 0; i < sweeps.size() && bytes < most_live_bytes; ++i) {
        const std::uint64_t pieces = xxh3_64(std::as_bytes(std::span{sweeps[i].ids}));
        if (!sweeps[i].closed || handed_out_.contains(pieces)) continue;
        handed_out.insert(pieces);
        Sweep sweep = join(sweeps[i]);
        if (sweep.radials.empty()) continue;  // joined they exceed the limit
        bytes += bytes_of(sweep);
        const bool whole = level2::is_whole(sweep);
        changed.push_back({std::move(sweep), i, whole});
    }
    handed_out_.merge(handed_out);
    return changed;
}

std::vector<LiveSweep> LiveVolume::take_sweeps() {
    try {
        return changed_sweeps();
    } catch (const std::bad_alloc&) {
        return {};  // they come when there is memory
    }
}

void LiveVolume::name_lost_chunks(VolumeBuilder& builder) const {
    std::vector<int> missing = missing_numbers();
    std::erase_if(missing, [&](int number) { return refused_.contains(number); });
    if (!missing.empty()) {
        builder.report().add(Severity::warning, "missing_chunks",
                             fmt::format("missing chunks: {}", fmt::join(missing, ", ")));
    }
    for (const auto& [number, reason] : refused_) {
        builder.report().add(Severity::error, "bad_chunk",
                             fmt::format("chunk {}: {}", number, reason));
    }
    if (!missing.empty()) builder.set_incomplete();
}

Result<Decoded> LiveVolume::join_all() {
    VolumeBuilder builder{options_.decode.output_limit_bytes};
    const DecodeOptions& options = options_.decode;
    PartDecoder decoder{options.output_limit_bytes, options.selection};
    DecodeReport& report = builder.report_data();
    name_lost_chunks(builder);
    bool first = true;
    for (auto& [number, chunk] : chunks_) {
        if (first) {
            report.container = chunk.has_records ? "ldm-bzip2" : "uncompressed";
            if (chunk.header) {
                builder.set_header(*chunk.header);
            } else {
                builder.report().add(Severity::note, "no_volume_header",
                                     "no 24-byte volume header");
            }
        } else if (chunk.header) {
            Status taken = builder.append(decoder.decode(header_part(*chunk.header)));
            if (!taken) return pass_on(taken);
        }
        first = false;
        for (Fragment& fragment : chunk.fragments) {
            if (Status taken = builder.append(std::exchange(fragment, {})); !taken) {
                return pass_on(taken);
            }
        }
    }
    return builder.finish(options.fallback_station);
}

Result<Decoded> LiveVolume::finish() {
    Result<Decoded> decoded = fail(ErrorCode::empty, "no chunk has come");
    if (chunks_.empty() && !refused_.empty()) {
        const auto& [number, reason] = *refused_.begin();
        decoded = fail(ErrorCode::corrupt, "no chunk is whole; chunk {}: {}", number, reason);
    }
    try {
        if (!chunks_.empty()) decoded = join_all();
    } catch (const std::bad_alloc&) {
        decoded = no_memory();
    }
    chunks_.clear();
    headers_.clear();
    refused_.clear();
    handed_out_.clear();
    return decoded;
}

}  // namespace stormcellar::level2
