#include "pipeline/keep/keep_rule.h"

#include <algorithm>
#include <chrono>
#include <system_error>

#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::pipeline {
namespace {

bool is_living(const grid::Provenance& provenance) {
    return provenance.partial &&
           std::any_of(provenance.notes.begin(), provenance.notes.end(),
                       [](const std::string& note) { return note.starts_with(living_note); });
}

// The first radial received of a volume is at most this far from its header.
constexpr std::chrono::minutes farthest_radial{15};

}  // namespace

std::optional<std::string> reason_to_keep(const std::filesystem::path& path,
                                          const cache::GridDescription& made) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return std::nullopt;
    const auto file = cache::GridFile::open(path);
    if (!file) return std::nullopt;
    const auto& stands = file->description();
    if (stands.spec != made.spec || stands.moment != made.moment) return std::nullopt;
    const auto& old = stands.provenance;
    const bool stands_living = is_living(old);
    const bool made_living = is_living(made.provenance);
    if (stands_living && !made_living) return std::nullopt;
    if (!stands_living && made_living)
        return "not replaced: the cache has a grid of the ended volume";
    const bool better = !old.partial && made.provenance.partial;
    const bool worse = old.partial && !made.provenance.partial;
    if (better) return "not replaced: the cache has a grid of the whole volume";
    if (!worse && old.source_modified_ns > made.provenance.source_modified_ns) {
        return "not replaced: the cache has a grid of a newer file of this volume";
    }
    return std::nullopt;
}

void keep_to_an_hours_volumes(cache::StoreWriter& store, const std::string& domain,
                              level2::Moment moment, UtcTime time) {
    constexpr std::chrono::minutes around{30};
    auto near = store.list(domain, moment, time - around, time + around);
    if (!near || near->size() <= most_volumes_an_hour) return;
    std::erase_if(
        *near, [&](const cache::StoreEntry& entry) { return entry.pinned || entry.time == time; });
    const auto written = [](const cache::StoreEntry& entry) {
        std::error_code error;
        const auto at = std::filesystem::last_write_time(entry.path, error);
        return error ? std::filesystem::file_time_type::max() : at;
    };
    const auto oldest =
        std::min_element(near->begin(), near->end(),
                         [&](const auto& a, const auto& b) { return written(a) < written(b); });
    if (oldest != near->end()) (void)store.remove(*oldest);
}

void remove_other_times(cache::StoreWriter& store, const std::string& domain, level2::Moment moment,
                        const level2::Volume& volume, const std::string& source_file) {
    const auto chunk = level2::parse_chunk_name(source_file);
    if (!chunk || !volume.header) return;
    const UtcTime time = volume.header->time();
    const auto near = store.list(domain, moment, time - farthest_radial, time + farthest_radial);
    if (!near) return;
    for (const cache::StoreEntry& entry : *near) {
        if (entry.time == time || entry.pinned) continue;
        const auto file = cache::GridFile::open(entry.path);
        if (!file || file->description().provenance.source_files.size() != 1) continue;
        const auto other =
            level2::parse_chunk_name(file->description().provenance.source_files.front());
        if (other && other->volume == chunk->volume) (void)store.remove(entry);
    }
}

}  // namespace stormcellar::pipeline
