#include "bench/restamp.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <bzlib.h>

#include "base/byte_reader.h"
#include "bunzip/bunzip.h"
#include "level2/containers/archive_header.h"
#include "level2/containers/ldm_framer.h"
#include "level2/messages/message_header.h"

namespace stormcellar::bench {
namespace {

using level2::message_header_bytes;
using level2::terminal_manager_bytes;

// Positions in the 24-byte header (ICD 2620010 section 7.3.3), in the header of a message and in
// the body of message 31 (ICD 2620002 tables II, XVII-A, XVII-E).
constexpr std::size_t header_day_at = 12, header_ms_at = 16, header_icao_at = 20;
constexpr std::size_t message_day_at = terminal_manager_bytes + 6;
constexpr std::size_t message_ms_at = terminal_manager_bytes + 8;
constexpr std::size_t radial_icao_at = 0, radial_ms_at = 4, radial_day_at = 8;
constexpr std::size_t block_count_at = 30, block_pointers_at = 32;
constexpr std::size_t volume_block_place_at = 8;  // latitude, longitude, two heights

void put_u16(std::span<std::byte> bytes, std::size_t at, std::uint16_t number) {
    bytes[at] = static_cast<std::byte>(number >> 8U);
    bytes[at + 1] = static_cast<std::byte>(number & 0xFFU);
}

void put_u32(std::span<std::byte> bytes, std::size_t at, std::uint32_t number) {
    put_u16(bytes, at, static_cast<std::uint16_t>(number >> 16U));
    put_u16(bytes, at + 2, static_cast<std::uint16_t>(number & 0xFFFFU));
}

void put_text(std::span<std::byte> bytes, std::size_t at, std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i)
        bytes[at + i] = static_cast<std::byte>(text[i]);
}

std::uint32_t u16_at(std::span<const std::byte> bytes, std::size_t at) {
    ByteReader reader{bytes.subspan(at)};
    return reader.u16();
}

std::uint32_t u32_at(std::span<const std::byte> bytes, std::size_t at) {
    ByteReader reader{bytes.subspan(at)};
    return reader.u32();
}

void move_time(std::span<std::byte> bytes, std::size_t day_at, std::size_t ms_at,
               std::chrono::milliseconds by) {
    const UtcTime time = time_from_nexrad(u16_at(bytes, day_at), u32_at(bytes, ms_at)) + by;
    const NexradTime moved = nexrad_from_time(time);
    put_u16(bytes, day_at, static_cast<std::uint16_t>(moved.day));
    put_u32(bytes, ms_at, moved.milliseconds);
}

bool is_legacy(const level2::Volume& volume) {
    return !volume.sweeps.empty() && volume.sweeps.front().message_type == 1;
}

// Sets the position. The altitude of the feed horn is the sum of both heights. They must differ,
// because a reader takes two equal heights for one height that a TDWR sends twice.
void move_to(const Station& station, level2::VolumeBlock& block) {
    constexpr int tower_m = 20;
    const auto altitude_m = static_cast<int>(std::lround(station.antenna_altitude_m));
    const int above_base_m = altitude_m == 2 * tower_m ? tower_m + 1 : tower_m;
    block.latitude_deg = static_cast<float>(station.latitude_deg);
    block.longitude_deg = static_cast<float>(station.longitude_deg);
    block.tower_height_m = static_cast<std::uint16_t>(above_base_m);
    block.site_height_m = static_cast<std::int16_t>(altitude_m - above_base_m);
}

void place_volume_block(std::span<std::byte> body, const Station& station) {
    level2::VolumeBlock place;
    move_to(station, place);
    const std::size_t blocks = std::min<std::size_t>(u16_at(body, block_count_at), 10);
    for (std::size_t i = 0; i < blocks; ++i) {
        const std::size_t at = u32_at(body, block_pointers_at + 4 * i);
        if (at + volume_block_place_at + 12 > body.size()) continue;
        const auto name = body.subspan(at, 4);
        constexpr std::string_view volume = "RVOL";
        const bool is_volume = std::equal(name.begin(), name.end(), volume.begin(),
                                          [](std::byte a, char b) { return a == std::byte(b); });
        if (!is_volume) continue;
        const std::size_t to = at + volume_block_place_at;
        put_u32(body, to, std::bit_cast<std::uint32_t>(place.latitude_deg));
        put_u32(body, to + 4, std::bit_cast<std::uint32_t>(place.longitude_deg));
        put_u16(body, to + 8, static_cast<std::uint16_t>(place.site_height_m));
        put_u16(body, to + 10, place.tower_height_m);
    }
}

void stamp_messages(std::span<std::byte> messages, const Station& station,
                    std::chrono::milliseconds by) {
    for (std::size_t at = 0; at + message_header_bytes <= messages.size();) {
        const auto header = level2::read_message_header(messages.subspan(at));
        const std::size_t length =
            header.has_own_length() ? header.length_bytes() : level2::frame_bytes;
        const std::size_t end = std::min(at + length, messages.size());
        const auto message = messages.subspan(at, end - at);
        if (header.type == 31 && message.size() > message_header_bytes + 72) {
            move_time(message, message_day_at, message_ms_at, by);
            const auto body = message.subspan(message_header_bytes);
            put_text(body, radial_icao_at, station.icao);
            move_time(body, radial_day_at, radial_ms_at, by);
            place_volume_block(body, station);
        }
        at = std::max(end, at + message_header_bytes);
    }
}

Bytes compressed(Bytes& messages) {
    // Use libbz2's bound on the size of its output.
    Bytes stream(messages.size() + messages.size() / 100 + 600);
    auto length = static_cast<unsigned>(stream.size());
    const int code = BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(stream.data()), &length,
                                              reinterpret_cast<char*>(messages.data()),
                                              static_cast<unsigned>(messages.size()), 9, 0, 0);
    if (code != BZ_OK) std::abort();
    stream.resize(length);
    return stream;
}

// Returns the decompressed bytes; empty if the input is not a bzip2 stream.
Bytes decompressed(std::span<const std::byte> stream) {
    Bytes messages;
    bunzip::Workspace workspace;
    const auto result =
        bunzip::decompress(stream, messages, level2::longest_record_bytes, workspace);
    messages.resize(result.status == bunzip::Status::whole ? result.output_bytes : 0);
    return messages;
}

}  // namespace

void move_times(level2::Volume& volume, std::chrono::milliseconds by) {
    if (volume.header) {
        const NexradTime time = nexrad_from_time(volume.header->time() + by);
        volume.header->date = time.day;
        volume.header->ms = time.milliseconds;
    }
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::Radial& radial : sweep.radials) {
            if (level2::is_plausible(radial.time)) radial.time += by;
        }
    }
}

void restamp(level2::Volume& volume, const Station& station, UtcTime start) {
    if (const auto starts = volume.start_time()) move_times(volume, start - *starts);
    const NexradTime time = nexrad_from_time(start);
    if (!volume.header || volume.header->icao.empty()) {
        volume.header.emplace();
        volume.header->filename = is_legacy(volume) ? "AR2V0001.001" : "AR2V0006.001";
    }
    volume.header->date = time.day;
    volume.header->ms = time.milliseconds;
    volume.header->icao = station.icao;
    volume.station = station.icao;
    if (volume.block) move_to(station, *volume.block);
}

void stamp_header_time(std::span<std::byte> header, UtcTime start) {
    const NexradTime time = nexrad_from_time(start);
    put_u32(header, header_day_at, time.day);
    put_u32(header, header_ms_at, time.milliseconds);
}

Result<StampedRecords> StampedRecords::read(std::span<const std::byte> file) {
    const auto header = level2::read_archive_header(file);
    if (!header) return fail(ErrorCode::not_level2, "there is no volume header");
    StampedRecords records;
    records.header_.assign(file.begin(), file.begin() + level2::archive_header_bytes);
    records.start_ = header->time();
    level2::LdmFramer framer(file);
    while (const auto part = framer.next()) {
        if (part->kind == level2::LdmPart::Kind::header && part->position == 0) continue;
        if (part->kind != level2::LdmPart::Kind::record || part->cut || part->bad_length) {
            return fail(ErrorCode::not_level2, "byte {} is in no LDM record", part->position);
        }
        Record record{decompressed(part->bytes), part->negative};
        if (record.messages.empty()) {
            return fail(ErrorCode::corrupt, "the record at byte {} is empty", part->position);
        }
        records.records_.push_back(std::move(record));
    }
    return records;
}

Bytes StampedRecords::stamped(const Station& station, UtcTime start) const {
    Bytes file = header_;
    stamp_header_time(file, start);
    put_text(file, header_icao_at, station.icao);
    for (const Record& record : records_) {
        Bytes messages = record.messages;
        stamp_messages(messages, station, start - start_);
        const Bytes stream = compressed(messages);
        const auto length = static_cast<std::int32_t>(stream.size());
        const std::size_t at = file.size();
        file.resize(at + 4);
        put_u32(file, at, static_cast<std::uint32_t>(record.negative ? -length : length));
        file.insert(file.end(), stream.begin(), stream.end());
    }
    return file;
}

std::uint64_t StampedRecords::message_bytes() const {
    std::uint64_t bytes = 0;
    for (const Record& record : records_)
        bytes += record.messages.size();
    return bytes;
}

}  // namespace stormcellar::bench
