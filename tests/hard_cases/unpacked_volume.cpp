#include "tests/hard_cases/unpacked_volume.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include <zlib.h>

#include "base/byte_reader.h"
#include "level2/messages/message_header.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

constexpr std::size_t header_bytes = 24;
constexpr std::size_t message_header_bytes = 28;

bool begins_with(std::span<const std::byte> bytes, std::string_view text) {
    return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

bool is_header(std::span<const std::byte> bytes) {
    return bytes.size() >= header_bytes &&
           (begins_with(bytes, "AR2V") || begins_with(bytes, "ARCHIVE2"));
}

Bytes gunzip(std::span<const std::byte> bytes) {
    z_stream z{};
    if (inflateInit2(&z, 15 + 16) != Z_OK) throw std::runtime_error("no zlib");
    Bytes in{bytes.begin(), bytes.end()};
    Bytes out(8 * bytes.size());
    z.next_in = reinterpret_cast<Bytef*>(in.data());
    z.avail_in = static_cast<uInt>(in.size());
    int code = Z_OK;
    std::size_t made = 0;
    while (code == Z_OK) {
        if (made == out.size()) out.resize(2 * out.size());
        z.next_out = reinterpret_cast<Bytef*>(out.data() + made);
        z.avail_out = static_cast<uInt>(out.size() - made);
        code = inflate(&z, Z_NO_FLUSH);
        made = out.size() - z.avail_out;
        // The file may have several gzip members.
        if (code == Z_STREAM_END && z.avail_in > 2 && *z.next_in == 0x1F) code = inflateReset(&z);
    }
    inflateEnd(&z);
    out.resize(made);
    return out;
}

std::size_t length_of(std::span<const std::byte> message) {
    if (is_header(message)) return header_bytes;
    if (message.size() < message_header_bytes) return message.size();
    const int type = std::to_integer<int>(message[15]);
    if (type != 31 && type != 29) return std::min(message.size(), frame_bytes);
    ByteReader reader{message};
    reader.skip(12);
    return std::min(message.size(), 12 + std::size_t{2} * reader.u16());
}

// Adds the messages in the stream from `from` on. Returns the number of radials among them.
std::size_t append_messages(UnpackedVolume& volume, std::size_t from) {
    const std::size_t radials_before = volume.radials;
    const std::span<const std::byte> stream = volume.stream;
    for (std::size_t at = from; at < stream.size();) {
        const auto rest = stream.subspan(at);
        StreamMessage message;
        message.offset = at;
        message.length = length_of(rest);
        message.type = is_header(rest)                      ? -1
                       : rest.size() < message_header_bytes ? 0
                                                            : std::to_integer<int>(rest[15]);
        if (message.type == 1 || message.type == 31) message.radial = volume.radials++;
        at += message.length;
        volume.messages.push_back(message);
    }
    return volume.radials - radials_before;
}

void append_record(UnpackedVolume& volume, std::span<const std::byte> record) {
    const std::size_t from = volume.stream.size();
    const bool further_header = is_header(record);
    const Bytes messages = further_header ? Bytes{} : wire::unpack_bzip2(record.subspan(4));
    volume.stream.insert(volume.stream.end(), messages.begin(), messages.end());
    volume.records.emplace_back(record.begin(), record.end());
    volume.radials_of_record.push_back(append_messages(volume, from));
}

void append_records(UnpackedVolume& volume, std::span<const std::byte> rest) {
    while (rest.size() > header_bytes) {
        std::size_t length = header_bytes;
        if (!is_header(rest)) {
            ByteReader reader{rest};
            const std::int64_t control = reader.i32();
            length = static_cast<std::size_t>(control < 0 ? -control : control) + 4;
        }
        append_record(volume, rest.first(std::min(length, rest.size())));
        rest = rest.subspan(std::min(length, rest.size()));
    }
}

void append(UnpackedVolume& volume, const UnpackedVolume& from, const StreamMessage& message) {
    const std::size_t at = volume.stream.size();
    const auto bytes = std::span{from.stream}.subspan(message.offset, message.length);
    volume.stream.insert(volume.stream.end(), bytes.begin(), bytes.end());
    append_messages(volume, at);
}

}  // namespace

Bytes UnpackedVolume::ldm_file() const {
    Bytes file = header;
    for (const Bytes& record : records)
        file.insert(file.end(), record.begin(), record.end());
    return file;
}

Bytes UnpackedVolume::plain_file() const {
    Bytes file = header;
    file.insert(file.end(), stream.begin(), stream.end());
    return file;
}

UnpackedVolume unpack(std::span<const std::byte> file, std::optional<std::uint64_t> stream_limit) {
    if (begins_with(file, "\x1F\x8B")) return unpack(gunzip(file), stream_limit);
    if (begins_with(file, "BZh")) return unpack(wire::unpack_bzip2(file), stream_limit);
    UnpackedVolume volume;
    if (is_header(file)) {
        volume.header.assign(file.begin(), file.begin() + header_bytes);
        file = file.subspan(header_bytes);
    }
    if (file.size() > 7 && begins_with(file.subspan(4), "BZh")) {
        append_records(volume, file);
        return volume;
    }
    if (stream_limit && *stream_limit < file.size()) file = file.first(*stream_limit);
    volume.stream.assign(file.begin(), file.end());
    append_messages(volume, 0);
    return volume;
}

UnpackedVolume short_records(const UnpackedVolume& whole, std::size_t most_bytes) {
    UnpackedVolume part;
    part.header = whole.header;
    const Bytes& last = whole.records.back();
    std::size_t bytes = last.size();
    for (std::size_t i = 0; i + 1 < whole.records.size(); ++i) {
        bytes += whole.records[i].size();
        if (i >= 2 && bytes > most_bytes) break;
        append_record(part, whole.records[i]);
    }
    append_record(part, last);
    return part;
}

UnpackedVolume short_stream(const UnpackedVolume& whole, std::size_t most_bytes) {
    constexpr std::size_t last_messages = 10;
    UnpackedVolume part;
    part.header = whole.header;
    const std::size_t count = whole.messages.size();
    const std::size_t tail = count - std::min(count, last_messages);
    for (std::size_t i = 0; i < count; ++i) {
        const StreamMessage& message = whole.messages[i];
        const bool fill = message.type == 0 && part.radials == 0 && part.messages.size() > 2;
        if (fill || (i < tail && part.stream.size() + message.length > most_bytes)) continue;
        append(part, whole, message);
    }
    return part;
}

}  // namespace stormcellar::level2
