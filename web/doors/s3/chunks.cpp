#include "web/doors/s3/chunks.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "base/parse_number.h"
#include "level2/containers/ldm_framer.h"
#include "stormcellar/base/utc_time.h"
#include "web/http/request.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t volume_header_bytes = 24, record_length_bytes = 4;
constexpr int last_volume = 999, last_chunk = 999;
constexpr std::size_t longest_number = 3;

// Reads bytes of a body. Returns false if the body is shorter, or cannot be read.
bool read_at(const Pieces& pieces, std::uint64_t offset, std::span<char> into) {
    std::size_t done = 0;
    for (const Piece& piece : part_of(pieces, offset, into.size())) {
        const std::size_t size = size_of(piece);
        if (const auto* text = std::get_if<Text>(&piece)) {
            std::memcpy(into.data() + done, (*text)->data(), size);
        } else if (const auto* slice = std::get_if<FileSlice>(&piece)) {
            const auto got = ::pread(slice->file->number(), into.data() + done, size,
                                     static_cast<off_t>(slice->offset));
            if (got != static_cast<ssize_t>(size)) return false;
        }
        done += size;
    }
    return done == into.size();
}

// Returns the length of the record that begins at this byte: its control word and its bzip2 stream.
// Returns none if no record begins there.
std::optional<std::uint64_t> record_at(const Pieces& pieces, std::uint64_t offset) {
    std::array<char, record_length_bytes + 3> begin{};
    if (!read_at(pieces, offset, begin)) return std::nullopt;
    if (std::string_view{begin.data() + record_length_bytes, 3} != "BZh") return std::nullopt;
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < record_length_bytes; ++i)
        word = word << 8 | static_cast<unsigned char>(begin[i]);
    // The last record of a volume has a negative length.
    const std::int64_t length = std::abs(std::int64_t{static_cast<std::int32_t>(word)});
    if (length > static_cast<std::int64_t>(level2::longest_record_bytes)) return std::nullopt;
    return record_length_bytes + static_cast<std::uint64_t>(length);
}

std::string volume_prefix(const RawVolume& volume) {
    std::string time = format_compact(volume.start);
    std::ranges::replace(time, '_', '-');
    return fmt::format("{}/{}/{}-", volume.station, *volume.number, time);
}

std::string s3_chunk_key(const RawVolume& volume, int number, level2::ChunkKind kind) {
    constexpr std::string_view letters = "SIE";
    return fmt::format("{}{:03}-{}", volume_prefix(volume), number,
                       letters[static_cast<std::size_t>(kind)]);
}

std::optional<int> chunk_number_of(std::string_view text, int most) {
    const auto number = parse_number<int>(text);
    const bool is_chunk =
        number && text.size() <= longest_number && *number >= 1 && *number <= most;
    return is_chunk ? number : std::nullopt;
}

// Returns true for volumes whose names tell that they consist of LDM records.
bool has_records(const RawVolume& volume) {
    return volume.number && *volume.number >= 1 && *volume.number <= last_volume &&
           volume.name.find("_V") != std::string::npos && !volume.name.ends_with(".gz");
}

}  // namespace

std::vector<VolumeChunk> chunks_of(const OpenedVolume& volume) {
    std::vector<VolumeChunk> chunks;
    std::array<char, record_length_bytes> begin{};
    if (!read_at(volume.bytes, 0, begin) || std::string_view{begin.data(), begin.size()} != "AR2V")
        return chunks;
    const std::uint64_t whole = size_of(volume.bytes);
    std::uint64_t at = volume_header_bytes;
    while (chunks.size() < last_chunk) {
        const auto length = record_at(volume.bytes, at);
        if (!length || at + *length > whole) break;
        const bool is_first = chunks.empty();
        const std::uint64_t offset = is_first ? 0 : at;
        at += *length;
        chunks.push_back({static_cast<int>(chunks.size()) + 1,
                          is_first ? level2::ChunkKind::start : level2::ChunkKind::intermediate,
                          offset, at - offset});
    }
    if (chunks.size() > 1 && volume.volume.is_complete) chunks.back().kind = level2::ChunkKind::end;
    return chunks;
}

std::string chunk_tag(const RawVolume& volume, const VolumeChunk& chunk) {
    // The tag of a growing file changes with each chunk that comes, but its chunks stay.
    if (volume.grows || volume.tag.size() < 2)
        return fmt::format("\"growing-{}-{}\"", volume.start.time_since_epoch().count(),
                           chunk.offset + chunk.size);
    return fmt::format("\"{}-{:03}\"", volume.tag.substr(1, volume.tag.size() - 2), chunk.number);
}

std::optional<S3ChunkKey> parse_s3_chunk_key(std::string_view key) {
    const auto segments = segments_of(key);
    if (segments.size() != 3 || key.front() == '/' || key.back() == '/') return std::nullopt;
    const auto name = level2::parse_chunk_name(segments[2]);
    const auto volume = chunk_number_of(segments[1], last_volume);
    if (!name || !volume || name->number > last_chunk) return std::nullopt;
    std::string time = name->volume;
    std::ranges::replace(time, '-', '_');
    const auto start = parse_utc(time, {});
    if (!start) return std::nullopt;
    S3ChunkKey parsed{std::string{segments[0]}, *volume, *start, name->number, name->kind};
    // Other names of chunks, as "20220317-000842-1-S", are no keys.
    RawVolume named;
    named.station = parsed.station;
    named.number = parsed.volume;
    named.start = parsed.start;
    if (s3_chunk_key(named, parsed.number, parsed.kind) != key) return std::nullopt;
    return parsed;
}

Result<const S3ChunkKeys::Ring*> S3ChunkKeys::ring_of(const std::string& station) {
    if (const auto known = rings_.find(station); known != rings_.end()) return &known->second;
    RawRange range;
    range.most = last_volume;
    range.newest_first = true;
    auto volumes = files_->list(station, range);
    if (!volumes) return pass_on(volumes);
    Ring& ring = rings_[station];
    for (RawVolume& volume : *volumes) {
        if (!has_records(volume)) continue;
        std::string number = std::to_string(*volume.number);
        ring.try_emplace(std::move(number), std::move(volume));
    }
    return &ring;
}

// Returns all chunks of a volume; none if it cannot be opened now.
std::vector<S3Object> S3ChunkKeys::of_volume(const RawVolume& volume) const {
    std::vector<S3Object> objects;
    const auto opened = files_->open(volume.station, volume.name);
    if (!opened) return objects;
    for (const VolumeChunk& chunk : chunks_of(*opened)) {
        S3Object object{s3_chunk_key(volume, chunk.number, chunk.kind), opened->volume};
        object.volume.tag = chunk_tag(opened->volume, chunk);
        object.volume.size_bytes = chunk.size;
        objects.push_back(std::move(object));
    }
    return objects;
}

Result<std::vector<S3Object>> S3ChunkKeys::between(std::string_view from, std::string_view end,
                                                   std::size_t most) {
    if (!stations_) {
        auto known = files_->stations();
        if (!known) return pass_on(known);
        stations_ = std::move(*known);
    }
    const auto is_behind = [end](std::string_view key) { return !end.empty() && key >= end; };
    for (const RawStation& station : *stations_) {
        const std::string begin = station.icao + "/";
        if (is_behind(begin)) break;
        if (begin < from && !from.starts_with(begin)) continue;
        const auto ring = ring_of(station.icao);
        if (!ring) return pass_on(ring);
        for (const auto& [number, volume] : **ring) {
            const std::string prefix = volume_prefix(volume);
            if (is_behind(prefix)) break;
            if (prefix < from && !from.starts_with(prefix)) continue;
            // A list of directories needs one key of each, so do not open the volumes.
            std::string first = s3_chunk_key(volume, 1, level2::ChunkKind::start);
            if (most == 1 && from <= first && !is_behind(first))
                return std::vector<S3Object>{{std::move(first), volume}};
            std::vector<S3Object> objects = of_volume(volume);
            std::erase_if(objects, [&](const S3Object& object) {
                return object.key < from || is_behind(object.key);
            });
            if (objects.size() > most) objects.resize(most);
            if (!objects.empty()) return objects;
        }
    }
    return std::vector<S3Object>{};
}

Status S3ChunkKeys::complete(S3Object& object) {
    if (object.volume.size_bytes > 0) return {};
    for (S3Object& found : of_volume(object.volume))
        if (found.key == object.key) object = std::move(found);
    return {};
}

}  // namespace stormcellar::web
