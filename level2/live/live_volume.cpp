#include "stormcellar/level2/live_volume.h"

#include <algorithm>
#include <new>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/checksum.h"
#include "level2/containers/archive_header.h"
#include "level2/containers/chunk_once.h"
#include "level2/decode/part_decoder.h"
#include "level2/decode/volume_builder.h"
#include "level2/live/open_sweep.h"

namespace stormcellar::level2 {
namespace {

constexpr int largest_number = 999;  // names have three digits

LdmPart header_part(const VolumeHeader& header) {
    LdmPart part;
    part.kind = LdmPart::Kind::header;
    part.header = header;
    return part;
}

bool is_same_volume(const VolumeHeader& a, const VolumeHeader& b) {
    return std::tie(a.filename, a.date, a.ms) == std::tie(b.filename, b.date, b.ms);
}

}  // namespace

LiveRoom LiveVolume::room_for(int number) const {
    LiveRoom left{options_.decode.output_limit_bytes, options_.decode.most_array_bytes()};
    for (const auto& [other_number, other] : chunks_) {
        if (other_number == number) continue;
        left.output_bytes -= std::min(left.output_bytes, other.output_bytes);
        left.held_bytes -= std::min(left.held_bytes, other.held_bytes);
    }
    return left;
}

Result<LiveVolume::Added> LiveVolume::keep_better(int number, LiveChunk chunk,
                                                  Clock::time_point now) {
    if (chunk.header) {
        const auto [first, is_new] = headers_.try_emplace(number, *chunk.header);
        if (!is_new && !is_same_volume(first->second, *chunk.header)) return Added::another_volume;
    }
    const auto there = chunks_.find(number);
    if (there == chunks_.end()) {
        last_arrival_ = std::max(last_arrival_, now);
        chunk.serial = next_serial_++;
        chunks_.emplace(number, std::move(chunk));
        return Added::added;
    }
    LiveChunk& old = there->second;
    // The chunk is the last one if any of its names says so.
    if (chunk.kind == ChunkKind::end) old.kind = ChunkKind::end;
    if (old.bytes == chunk.bytes && old.checksum == chunk.checksum) return Added::repeated;
    const auto worth = [](const LiveChunk& c) { return std::tie(c.radials, c.bytes, c.checksum); };
    if (worth(chunk) < worth(old)) return Added::worse;
    last_arrival_ = std::max(last_arrival_, now);
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
        bytes = chunk_once(bytes);
        Result<LiveChunk> chunk = read_live_chunk(bytes, options_.decode, room_for(number));
        if (chunk) {
            chunk->kind = kind;
            refused_.erase(number);
            auto kept = keep_better(number, std::move(*chunk), now);
            const bool is_new = kept && (*kept == Added::added || *kept == Added::replaced);
            if (is_new && options_.depot != nullptr) {
                put_aside(chunks_.at(number), *options_.depot);
            }
            return kept;
        }
        if (chunk.error().cause() == Cause::data && !chunks_.contains(number)) {
            // Keep the alphabetically first reason, so that the order of arrival does not matter.
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
        const LiveChunk& chunk = entry.second;
        // A negative control word counts only with radials, because in a start chunk it marks the
        // last record of the metadata.
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

std::uint64_t LiveVolume::held_bytes() const {
    std::uint64_t bytes = 0;
    for (const auto& [number, chunk] : chunks_)
        bytes += chunk.held_bytes - chunk.away_bytes;
    return bytes;
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

std::vector<LiveSweep> LiveVolume::changed_sweeps() {
    std::vector<LiveSweep> changed;
    std::set<std::uint64_t> handed_out;
    std::uint64_t bytes = 0;
    const std::vector<OpenSweep> sweeps = sweeps_of(chunks_);
    for (std::size_t i = 0; i < sweeps.size() && bytes < most_live_bytes; ++i) {
        const std::uint64_t pieces = xxh3_64(std::as_bytes(std::span{sweeps[i].ids}));
        if (!sweeps[i].closed || handed_out_.contains(pieces)) continue;
        handed_out.insert(pieces);
        Result<Sweep> sweep = join(sweeps[i], options_.decode.most_array_bytes(), options_.depot);
        // Skip pieces that exceed the limit when joined, or that the depot cannot return. finish()
        // reports the error.
        if (!sweep || sweep->radials.empty()) continue;
        bytes += bytes_of(*sweep);
        const bool whole = level2::is_whole(*sweep);
        changed.push_back({std::move(*sweep), i, whole});
    }
    handed_out_.merge(handed_out);
    return changed;
}

std::vector<LiveSweep> LiveVolume::take_sweeps() {
    try {
        return changed_sweeps();
    } catch (const std::bad_alloc&) {
        return {};  // the next call tries again
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
    VolumeBuilder builder{options_.decode.output_limit_bytes, options_.decode.most_array_bytes()};
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
        if (Status back = bring_back(chunk, options_.depot); !back) return pass_on(back);
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
        decoded = fail(ErrorCode::corrupt, "no chunk is intact; chunk {}: {}", number, reason);
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
