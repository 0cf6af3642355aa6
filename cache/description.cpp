#include "cache/description.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "cache/format.h"

namespace stormcellar::cache {
namespace {

enum class RecordKind : std::uint16_t {
    source_file = 1,
    station = 2,
    method = 3,
    beam_model = 4,
    averaging = 5,
    software_version = 6,
    vcp = 7,
    partial = 8,
    note = 9,
    site = 10,
    source_modified = 11,
};

struct RecordHead {
    std::uint16_t kind = 0;
    std::uint16_t reserved = 0;
    std::uint32_t length = 0;
};
static_assert(sizeof(RecordHead) == 8);

constexpr std::size_t site_numbers_bytes = 3 * sizeof(double);

template <class T>
void append(std::vector<std::byte>& bytes, const T* first, std::size_t count) {
    const auto part = std::as_bytes(std::span(first, count));
    bytes.insert(bytes.end(), part.begin(), part.end());
}

void append_record(std::vector<std::byte>& bytes, RecordKind kind,
                   std::span<const std::byte> contents) {
    // A length beyond 32 bits is cut here, and refused by the writer, which sees the true size.
    const RecordHead head{static_cast<std::uint16_t>(kind), 0,
                          static_cast<std::uint32_t>(contents.size())};
    append(bytes, &head, 1);
    bytes.insert(bytes.end(), contents.begin(), contents.end());
    bytes.resize(format::round_up(bytes.size(), 8));
}

void append_text(std::vector<std::byte>& bytes, RecordKind kind, std::string_view text) {
    append_record(bytes, kind, std::as_bytes(std::span(text.data(), text.size())));
}

void append_site(std::vector<std::byte>& bytes, const grid::SitePosition& site) {
    const std::array<double, 3> numbers = {site.latitude_deg, site.longitude_deg, site.altitude_m};
    std::vector<std::byte> contents;
    append(contents, numbers.data(), numbers.size());
    append(contents, site.icao.data(), site.icao.size());
    append_record(bytes, RecordKind::site, contents);
}

std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <class Number>
bool read_number(std::span<const std::byte> bytes, Number& number) {
    if (bytes.size() != sizeof number) return false;
    std::memcpy(&number, bytes.data(), sizeof number);
    return true;
}

bool read_site(std::span<const std::byte> bytes, GridDescription& description) {
    if (bytes.size() < site_numbers_bytes) return false;
    std::array<double, 3> numbers{};
    std::memcpy(numbers.data(), bytes.data(), site_numbers_bytes);
    description.sites.push_back(
        {text_of(bytes.subspan(site_numbers_bytes)), numbers[0], numbers[1], numbers[2]});
    return true;
}

// False when the contents have a size that their kind cannot have.
bool read_record(RecordKind kind, std::span<const std::byte> contents,
                 GridDescription& description) {
    grid::Provenance& provenance = description.provenance;
    switch (kind) {
        case RecordKind::source_file:
            provenance.source_files.push_back(text_of(contents));
            return true;
        case RecordKind::station:
            provenance.stations.push_back(text_of(contents));
            return true;
        case RecordKind::method:
            provenance.method = text_of(contents);
            return true;
        case RecordKind::beam_model:
            provenance.beam_model = text_of(contents);
            return true;
        case RecordKind::averaging:
            provenance.averaging = text_of(contents);
            return true;
        case RecordKind::software_version:
            provenance.software_version = text_of(contents);
            return true;
        case RecordKind::vcp: {
            std::int32_t number = 0;
            const bool whole = read_number(contents, number);
            provenance.vcp = number;
            return whole;
        }
        case RecordKind::partial: {
            std::int32_t number = 0;
            const bool whole = read_number(contents, number);
            provenance.partial = number != 0;
            return whole;
        }
        case RecordKind::note:
            provenance.notes.push_back(text_of(contents));
            return true;
        case RecordKind::source_modified:
            return read_number(contents, provenance.source_modified_ns);
        case RecordKind::site:
            return read_site(contents, description);
    }
    return true;  // of a later version
}

}  // namespace

std::vector<std::byte> encode_description(const GridDescription& description) {
    const grid::Provenance& provenance = description.provenance;
    std::vector<std::byte> bytes;
    for (const auto& name : provenance.source_files) {
        append_text(bytes, RecordKind::source_file, name);
    }
    for (const auto& station : provenance.stations)
        append_text(bytes, RecordKind::station, station);
    append_text(bytes, RecordKind::method, provenance.method);
    append_text(bytes, RecordKind::beam_model, provenance.beam_model);
    append_text(bytes, RecordKind::averaging, provenance.averaging);
    append_text(bytes, RecordKind::software_version, provenance.software_version);
    const std::int32_t vcp = provenance.vcp;
    append_record(bytes, RecordKind::vcp, std::as_bytes(std::span(&vcp, 1)));
    const std::int32_t partial = provenance.partial ? 1 : 0;
    append_record(bytes, RecordKind::partial, std::as_bytes(std::span(&partial, 1)));
    const std::int64_t modified_ns = provenance.source_modified_ns;
    append_record(bytes, RecordKind::source_modified, std::as_bytes(std::span(&modified_ns, 1)));
    for (const auto& note : provenance.notes)
        append_text(bytes, RecordKind::note, note);
    for (const auto& site : description.sites)
        append_site(bytes, site);
    return bytes;
}

Status decode_description(std::span<const std::byte> bytes, GridDescription& description) {
    while (!bytes.empty()) {
        RecordHead head;
        if (bytes.size() < sizeof head) {
            return fail(ErrorCode::corrupt, "the description ends inside a record");
        }
        std::memcpy(&head, bytes.data(), sizeof head);
        bytes = bytes.subspan(sizeof head);
        const std::uint64_t padded = format::round_up(head.length, 8);
        if (padded > bytes.size()) {
            return fail(ErrorCode::corrupt, "the description ends inside a record");
        }
        if (!read_record(static_cast<RecordKind>(head.kind), bytes.first(head.length),
                         description)) {
            return fail(ErrorCode::corrupt, "a record of kind {} cannot have {} bytes", head.kind,
                        head.length);
        }
        bytes = bytes.subspan(padded);
    }
    return {};
}

}  // namespace stormcellar::cache
