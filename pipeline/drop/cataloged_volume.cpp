#include "pipeline/drop/cataloged_volume.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "base/checksum.h"
#include "level2/containers/chunk_once.h"
#include "pipeline/drop/chunk_path.h"
#include "pipeline/drop/drop_names.h"
#include "stormcellar/catalog/read_cataloged.h"

namespace stormcellar::pipeline {
namespace {

using catalog::CatalogEntry;
using catalog::CatalogReader;

constexpr std::size_t most_chunks = 2000;

Result<std::vector<std::byte>> read(const CatalogReader& catalog, const CatalogEntry& entry,
                                    CatalogedVolume& volume) {
    auto read = catalog::read_cataloged(catalog, entry);
    if (!read) return pass_on(read);
    if (!read->is_compared) {
        volume.notes.push_back(fmt::format(
            "{}: was still growing when it was cataloged, so its contents were not compared",
            entry.path.native()));
    }
    return std::move(read->bytes);
}

Result<CatalogedVolume> read_chunks(const CatalogReader& catalog, const CatalogEntry& entry,
                                    const ChunkPath& first) {
    const auto root = catalog::root_of(catalog, entry.path);
    if (!root) return pass_on(root);
    auto chunks = chunks_beside(first, *root);
    if (!chunks) return pass_on(chunks);
    chunks->insert(chunks->begin(), first);
    CatalogedVolume volume;
    int due = 1;
    for (const ChunkPath& chunk : *chunks) {
        if (chunk.name.number < due) continue;  // another chunk with this number was taken
        const auto row = catalog.find_file(entry.station, chunk.path);
        if (!row) return pass_on(row);
        if (!row->has_value()) {
            volume.notes.push_back(fmt::format("{}: is left out because it is not in the catalog",
                                               chunk.path.native()));
            continue;
        }
        if (chunk.name.number > due) {
            volume.notes.push_back(
                fmt::format("{}: chunks are missing before this one", chunk.path.native()));
        }
        due = chunk.name.number + 1;
        const auto bytes = read(catalog, **row, volume);
        if (!bytes) return pass_on(bytes);
        const auto once = level2::chunk_once(*bytes);
        volume.bytes.insert(volume.bytes.end(), once.begin(), once.end());
    }
    return volume;
}

}  // namespace

bool is_of_chunks(const CatalogEntry& entry) {
    return entry.volume.start_time && is_chunk_name(entry.path);
}

Result<std::optional<catalog::CatalogEntry>> find_cataloged_volume(
    const catalog::CatalogReader& catalog, const std::string& station, UtcTime start,
    const std::function<bool(const catalog::CatalogEntry&)>& is_meant) {
    auto entries = catalog.list(station, {start, start});
    if (!entries) return pass_on(entries);
    const auto rank = [&](const catalog::CatalogEntry& entry) {
        return std::pair{entry.state == catalog::FileState::gone, !is_meant(entry)};
    };
    const auto best = std::ranges::min_element(*entries, {}, rank);
    if (best == entries->end()) return std::optional<catalog::CatalogEntry>{};
    return std::optional{std::move(*best)};
}

Result<std::optional<catalog::CatalogEntry>> find_volume_of_grid(
    const catalog::CatalogReader& catalog, const std::string& station, UtcTime start,
    bool is_partial) {
    return find_cataloged_volume(catalog, station, start, [&](const catalog::CatalogEntry& entry) {
        return entry.volume.complete != is_partial;
    });
}

Result<std::uint64_t> hash_of_growing_rows(const CatalogReader& catalog,
                                           const CatalogEntry& entry) {
    const auto first = ChunkPath::of(entry.path);
    if (!first || !is_of_chunks(entry) || catalog::has_final_hash(entry)) return 0;
    const std::string prefix = (entry.path.parent_path() / first->prefix).native();
    const auto rows = catalog.files_with_prefix(entry.station, prefix, most_chunks);
    if (!rows) return pass_on(rows);
    Xxh3Stream hashes;
    for (const CatalogEntry& row : *rows) {
        const std::array<std::uint64_t, 2> words = {row.content_hash, row.size_bytes};
        hashes.append(std::as_bytes(std::span{words}));
    }
    return hashes.value();
}

Result<CatalogedVolume> read_cataloged_volume(const CatalogReader& catalog,
                                              const CatalogEntry& entry) {
    const auto chunk = ChunkPath::of(entry.path);
    if (chunk && is_of_chunks(entry)) return read_chunks(catalog, entry, *chunk);
    CatalogedVolume volume;
    auto bytes = read(catalog, entry, volume);
    if (!bytes) return pass_on(bytes);
    volume.bytes = std::move(*bytes);
    return volume;
}

}  // namespace stormcellar::pipeline
