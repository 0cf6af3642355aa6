#include "level2/containers/archive_header.h"

#include <algorithm>

#include "base/byte_reader.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::level2 {

std::optional<VolumeHeader> read_archive_header(std::span<const std::byte> bytes) {
    if (bytes.size() < archive_header_bytes) return std::nullopt;
    ByteReader reader{bytes};
    const std::string_view filename = reader.text(12);
    const bool known = filename.starts_with("AR2V") || filename.starts_with("ARCHIVE2");
    if (!known || filename[8] != '.') return std::nullopt;
    VolumeHeader header;
    header.filename = filename;
    const auto unprintable = [](char c) { return c < ' ' || c > '~'; };
    std::replace_if(header.filename.begin(), header.filename.end(), unprintable, '?');
    header.date = reader.u32();
    header.ms = reader.u32();
    header.icao = icao_of(reader.text(4)).value_or("");
    return header;
}

}  // namespace stormcellar::level2
