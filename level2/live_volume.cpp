#include "level2/live_volume.h"

#include <algorithm>
#include <tuple>

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

Fragment read_messages(std::span<const std::byte> bytes, const DecodeOptions& options) {
    FragmentBuilder builder{options.output_limit_bytes, rows_of_a_chunk, options.selection};
    MessageReader reader{builder};
    (void)reader.read(bytes, true);
    Fragment fragment = builder.take();
    fragment.output_bytes = bytes.size();
    if (reader.full()) fragment.failure = Fragment::Failure::too_large_arrays;
    return fragment;
}

LdmPart header_part(const VolumeHeader& header) {
    LdmPart part;
    part.kind = LdmPart::Kind::header;
    part.header = header;
    return part;
}

bool holds_messages(const DecodeReport& report) {
    return std::any_of(report.message_counts.begin(), report.message_counts.end(),
                       [](const auto& count) { return count.first != 0; });
}

}  // namespace

Result<LiveVolume::Chunk> LiveVolume::read_chunk(std::span<const std::byte> bytes) const {
    if (bytes.empty()) return fail(ErrorCode::empty, "the chunk is empty");
    Chunk chunk;
    const Content content = content_anywhere(bytes);
    chunk.header = read_archive_header(bytes);
    const auto body = bytes.subspan(chunk.header ? archive_header_bytes : 0);
    // A header with the first bytes of a record tells which volume it is.
    if (content == Content::ldm || (content == Content::unknown && chunk.header)) {
        chunk.has_records = true;
        PartDecoder decoder{options_.decode.output_limit_bytes, options_.decode.selection};
        LdmFramer framer{body};
        while (const auto part = framer.next()) {
            if (part->kind == LdmPart::Kind::record) chunk.negative = part->negative;
            chunk.fragments.push_back(decoder.decode(*part));
        }
    } else if (content == Content::messages) {
        chunk.fragments.push_back(read_messages(body, options_.decode));
    } else {
        return fail(ErrorCode::not_level2, "not a chunk of a Level II volume");
    }
    bool anything = chunk.header.has_value();
    bool is_cut = false;
    for (const Fragment& fragment : chunk.fragments) {
        if (fragment.failure != Fragment::Failure::none) {
            return fail(ErrorCode::unsupported, "the chunk takes more memory than it may");
        }
        chunk.output_bytes += fragment.output_bytes;
        chunk.array_bytes += fragment.array_bytes;
        anything = anything || holds_messages(fragment.report);
        is_cut = is_cut || fragment.cut;
        for (const Fragment::Piece& piece : fragment.pieces) {
            chunk.radials += piece.sweep.radials.size();
            const RadialStatus last = status_of(piece.sweep.radials.back());
            chunk.ended_volume = chunk.ended_volume || last == RadialStatus::end_of_volume;
        }
    }
    if (!anything) {
        return fail(is_cut ? ErrorCode::truncated : ErrorCode::corrupt,
                    "nothing in the chunk is whole");
    }
    chunk.bytes = bytes.size();
    chunk.checksum = xxh3_64(bytes);
    return chunk;
}

// Beside all others, instead of the one that has its number now.
bool LiveVolume::has_room_for(const Chunk& chunk, int number) const {
    std::uint64_t output_bytes = chunk.output_bytes;
    std::uint64_t array_bytes = chunk.array_bytes;
    for (const auto& [other_number, other] : chunks_) {
        if (other_number == number) continue;
        output_bytes += other.output_bytes;
        array_bytes += other.array_bytes;
    }
    return std::max(output_bytes, array_bytes) <= options_.decode.output_limit_bytes;
}

Result<LiveVolume::Added> LiveVolume::add(int number, ChunkKind kind,
                                          std::span<const std::byte> bytes, Clock::time_point now) {
    if (number < 1 || number > largest_number) {
        return fail(ErrorCode::bad_argument, "chunks are numbered from 1 to {}, not {}",
                    largest_number, number);
    }
    Result<Chunk> read = read_chunk(bytes);
    if (!read) return pass_on(read);
    Chunk& chunk = *read;
    chunk.kind = kind;
    const auto there = chunks_.find(number);
    if (there != chunks_.end()) {
        const Chunk& old = there->second;
        if (old.bytes == chunk.bytes && old.checksum == chunk.checksum) return Added::repeated;
        const auto same_volume = [](const VolumeHeader& a, const VolumeHeader& b) {
            return std::tie(a.filename, a.date, a.ms) == std::tie(b.filename, b.date, b.ms);
        };
        if (old.header && chunk.header && !same_volume(*old.header, *chunk.header)) {
            return Added::another_volume;
        }
        const auto worth = [](const Chunk& c) { return std::tie(c.radials, c.bytes, c.checksum); };
        if (worth(chunk) < worth(old)) return Added::worse;
    }
    if (!has_room_for(chunk, number)) {
        return fail(ErrorCode::unsupported, "the chunks take more than the limit of {} bytes",
                    options_.decode.output_limit_bytes);
    }
    last_arrival_ = now;
    chunk.serial = next_serial_++;
    const bool replaced = there != chunks_.end();
    chunks_[number] = std::move(chunk);
    return replaced ? Added::replaced : Added::added;
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
    (void)builder.close_sweeps();
    return builder.so_far().sweeps.empty() ? Sweep{} : builder.so_far().sweeps.front();
}

std::vector<LiveSweep> LiveVolume::take_sweeps() {
    std::vector<LiveSweep> changed;
    const std::vector<OpenSweep> sweeps = sweeps_by_piece();
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
        if (!sweeps[i].closed || !handed_out_.insert(sweeps[i].ids).second) continue;
        Sweep sweep = join(sweeps[i]);
        if (sweep.radials.empty()) continue;  // joined they exceed the limit
        const bool whole = level2::is_whole(sweep);
        changed.push_back({std::move(sweep), i, whole});
    }
    return changed;
}

Result<Decoded> LiveVolume::finish() {
    VolumeBuilder builder{options_.decode.output_limit_bytes};
    if (chunks_.empty()) return fail(ErrorCode::empty, "no chunk has come");
    std::map<int, Chunk> chunks = std::exchange(chunks_, {});
    handed_out_.clear();
    const DecodeOptions& options = options_.decode;
    PartDecoder decoder{options.output_limit_bytes, options.selection};
    DecodeReport& report = builder.report_data();
    bool first = true;
    for (auto& [number, chunk] : chunks) {
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
            if (Status taken = builder.append(std::move(fragment)); !taken) return pass_on(taken);
        }
        chunk.fragments.clear();
    }
    return builder.finish(options.fallback_station);
}

}  // namespace stormcellar::level2
