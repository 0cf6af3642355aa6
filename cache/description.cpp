#include "cache/description.h"

#include <algorithm>
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
    source_modified = 11,  // of version 1 only
    parallels = 12,
    effects = 13,
    predicted_error = 14,
    sweep = 15,
    frame = 16,
    audit = 17,
    frame_part = 18,
    recipe = 19,
    radar_trouble = 20,
    left_out = 21,
};

// A kind of record that holds one text, and the member of the provenance that the text is from. If
// the text is `optional` and empty, no record is written.
struct TextRecord {
    RecordKind kind;
    std::string grid::Provenance::*text;
    bool optional = false;
};
constexpr std::array<TextRecord, 6> text_records = {
    {{RecordKind::method, &grid::Provenance::method},
     {RecordKind::beam_model, &grid::Provenance::beam_model},
     {RecordKind::averaging, &grid::Provenance::averaging},
     {RecordKind::software_version, &grid::Provenance::software_version},
     {RecordKind::effects, &grid::Provenance::effects, true},
     {RecordKind::predicted_error, &grid::Provenance::predicted_error, true}}};

// A kind of record that holds one text of a list, and the member of the provenance that has the
// list.
struct ListRecord {
    RecordKind kind;
    std::vector<std::string> grid::Provenance::*list;
};
constexpr std::array<ListRecord, 5> list_records = {
    {{RecordKind::source_file, &grid::Provenance::source_files},
     {RecordKind::station, &grid::Provenance::stations},
     {RecordKind::note, &grid::Provenance::notes},
     {RecordKind::radar_trouble, &grid::Provenance::radar_troubles},
     {RecordKind::left_out, &grid::Provenance::left_out}}};
constexpr std::size_t lists_before_texts = 2;

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
    // The length loses bits above 32, but the writer knows the true size and refuses a record that
    // is so long.
    const RecordHead head{static_cast<std::uint16_t>(kind), 0,
                          static_cast<std::uint32_t>(contents.size())};
    append(bytes, &head, 1);
    bytes.insert(bytes.end(), contents.begin(), contents.end());
    bytes.resize(format::round_up(bytes.size(), 8));
}

void append_text(std::vector<std::byte>& bytes, RecordKind kind, std::string_view text) {
    append_record(bytes, kind, std::as_bytes(std::span(text.data(), text.size())));
}

void append_lists(std::vector<std::byte>& bytes, std::span<const ListRecord> records,
                  const grid::Provenance& provenance) {
    for (const ListRecord& record : records)
        for (const std::string& text : provenance.*record.list)
            append_text(bytes, record.kind, text);
}

void append_site(std::vector<std::byte>& bytes, const grid::SitePosition& site) {
    const std::array<double, 3> numbers = {site.latitude_deg, site.longitude_deg, site.altitude_m};
    std::vector<std::byte> contents;
    append(contents, numbers.data(), numbers.size());
    append(contents, site.icao.data(), site.icao.size());
    append_record(bytes, RecordKind::site, contents);
}

// The form of a sweep in a record.
struct StoredSweep {
    double elevation_deg = 0;
    std::int64_t start_ms = 0;
    double first_azimuth_deg = 0;
    double degrees_per_s = 0;
};
static_assert(sizeof(StoredSweep) == 32);

void append_sweep(std::vector<std::byte>& bytes, const grid::SweepTime& sweep) {
    const StoredSweep stored{sweep.elevation_deg, sweep.start.time_since_epoch().count(),
                             sweep.first_azimuth_deg, sweep.degrees_per_s};
    append_record(bytes, RecordKind::sweep, std::as_bytes(std::span(&stored, 1)));
}

// The form of a part in a record. The part's ICAO follows.
struct StoredPart {
    std::int64_t time_ms = 0;
    std::uint64_t fingerprint = 0;
    std::int32_t first_x = 0, first_y = 0, nx = 0, ny = 0;
};
static_assert(sizeof(StoredPart) == 32);

void append_part(std::vector<std::byte>& bytes, const grid::FramePart& part) {
    const StoredPart stored{part.time.time_since_epoch().count(),
                            part.fingerprint,
                            part.window.first_x,
                            part.window.first_y,
                            part.window.nx,
                            part.window.ny};
    std::vector<std::byte> contents;
    append(contents, &stored, 1);
    append(contents, part.icao.data(), part.icao.size());
    append_record(bytes, RecordKind::frame_part, contents);
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

bool read_flag(std::span<const std::byte> bytes, bool& flag) {
    std::int32_t number = 0;
    if (!read_number(bytes, number)) return false;
    flag = number != 0;
    return true;
}

bool read_pattern(std::span<const std::byte> bytes, grid::Provenance& provenance) {
    std::int32_t number = 0;
    const bool whole = read_number(bytes, number);
    provenance.vcp = number;
    return whole;
}

bool read_site(std::span<const std::byte> bytes, GridDescription& description) {
    if (bytes.size() < site_numbers_bytes) return false;
    std::array<double, 3> numbers{};
    std::memcpy(numbers.data(), bytes.data(), site_numbers_bytes);
    description.sites.push_back(
        {text_of(bytes.subspan(site_numbers_bytes)), numbers[0], numbers[1], numbers[2]});
    return true;
}

// Returns true if the part's columns could be columns of a grid.
bool is_window(const StoredPart& part) {
    constexpr std::int32_t most = grid::GridSpec::greatest_side;
    const auto lies_within = [](std::int32_t first, std::int32_t count) {
        return first >= 0 && first < most && count >= 1 && count <= most - first;
    };
    return lies_within(part.first_x, part.nx) && lies_within(part.first_y, part.ny);
}

bool read_part(std::span<const std::byte> bytes, GridDescription& description) {
    StoredPart stored;
    if (bytes.size() < sizeof stored) return false;
    std::memcpy(&stored, bytes.data(), sizeof stored);
    if (!is_window(stored)) return false;
    description.provenance.parts.push_back(
        {text_of(bytes.subspan(sizeof stored)),
         UtcTime{std::chrono::milliseconds{stored.time_ms}},
         stored.fingerprint,
         {stored.first_x, stored.first_y, stored.nx, stored.ny}});
    return true;
}

bool read_sweep(std::span<const std::byte> bytes, GridDescription& description) {
    StoredSweep stored;
    if (!read_number(bytes, stored)) return false;
    description.provenance.sweeps.push_back({stored.elevation_deg,
                                             UtcTime{std::chrono::milliseconds{stored.start_ms}},
                                             stored.first_azimuth_deg, stored.degrees_per_s});
    return true;
}

bool read_frame(std::span<const std::byte> bytes, GridDescription& description) {
    std::array<std::int32_t, 2> numbers{};
    if (!read_number(bytes, numbers)) return false;
    description.provenance.provisional = numbers[0] != 0;
    description.provenance.revision = numbers[1];
    return true;
}

bool read_audit(std::span<const std::byte> bytes, std::vector<grid::AuditRow>& rows) {
    if (bytes.size() % sizeof(grid::AuditRow) != 0) return false;
    std::vector<grid::AuditRow> read(bytes.size() / sizeof(grid::AuditRow));
    if (!read.empty()) std::memcpy(read.data(), bytes.data(), bytes.size());
    rows = std::move(read);
    return std::all_of(rows.begin(), rows.end(), grid::is_possible);
}

// Reads a record of text_records or list_records. Returns false for a record of any other kind.
bool read_text_record(RecordKind kind, std::span<const std::byte> contents,
                      grid::Provenance& provenance) {
    for (const TextRecord& record : text_records) {
        if (record.kind != kind) continue;
        provenance.*record.text = text_of(contents);
        return true;
    }
    const auto record = std::ranges::find(list_records, kind, &ListRecord::kind);
    if (record == list_records.end()) return false;
    (provenance.*record->list).push_back(text_of(contents));
    return true;
}

// Returns false if a record of this kind cannot have contents of this size, or with these numbers.
bool read_record(RecordKind kind, std::span<const std::byte> contents,
                 GridDescription& description) {
    grid::Provenance& provenance = description.provenance;
    if (read_text_record(kind, contents, provenance)) return true;
    switch (kind) {
        case RecordKind::vcp:
            return read_pattern(contents, provenance);
        case RecordKind::partial:
            return read_flag(contents, provenance.partial);
        case RecordKind::parallels:
            return read_number(contents, description.spec.parallels_deg);
        case RecordKind::site:
            return read_site(contents, description);
        case RecordKind::sweep:
            return read_sweep(contents, description);
        case RecordKind::frame:
            return read_frame(contents, description);
        case RecordKind::frame_part:
            return read_part(contents, description);
        case RecordKind::recipe:
            return read_number(contents, provenance.recipe);
        case RecordKind::audit:
            return read_audit(contents, provenance.audit);
        default:
            return true;  // source_modified, or a kind of a later version
    }
}

}  // namespace

std::vector<std::byte> encode_description(const GridDescription& description) {
    const grid::Provenance& provenance = description.provenance;
    std::vector<std::byte> bytes;
    append_lists(bytes, std::span(list_records).first(lists_before_texts), provenance);
    for (const TextRecord& record : text_records) {
        const std::string& text = provenance.*record.text;
        if (!record.optional || !text.empty()) append_text(bytes, record.kind, text);
    }
    const std::int32_t vcp = provenance.vcp;
    append_record(bytes, RecordKind::vcp, std::as_bytes(std::span(&vcp, 1)));
    const std::int32_t partial = provenance.partial ? 1 : 0;
    append_record(bytes, RecordKind::partial, std::as_bytes(std::span(&partial, 1)));
    append_lists(bytes, std::span(list_records).subspan(lists_before_texts), provenance);
    if (grid::facts_of(description.spec.projection).takes_parallels) {
        append_record(bytes, RecordKind::parallels,
                      std::as_bytes(std::span(description.spec.parallels_deg)));
    }
    for (const auto& site : description.sites)
        append_site(bytes, site);
    for (const auto& sweep : provenance.sweeps)
        append_sweep(bytes, sweep);
    if (provenance.revision != 0 || provenance.provisional) {
        const std::array<std::int32_t, 2> frame = {provenance.provisional ? 1 : 0,
                                                   provenance.revision};
        append_record(bytes, RecordKind::frame, std::as_bytes(std::span(frame)));
    }
    for (const auto& part : provenance.parts)
        append_part(bytes, part);
    if (provenance.recipe != 0) {
        append_record(bytes, RecordKind::recipe, std::as_bytes(std::span(&provenance.recipe, 1)));
    }
    if (!provenance.audit.empty()) {
        append_record(bytes, RecordKind::audit, std::as_bytes(std::span(provenance.audit)));
    }
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
            return fail(ErrorCode::corrupt, "a record of kind {} cannot have these {} bytes",
                        head.kind, head.length);
        }
        bytes = bytes.subspan(padded);
    }
    return {};
}

}  // namespace stormcellar::cache
