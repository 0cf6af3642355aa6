#include "pipeline/keep/keep_rule.h"

#include <algorithm>
#include <chrono>
#include <system_error>

#include "base/checksum.h"
#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::pipeline {
namespace {

bool is_living(const grid::Provenance& provenance) {
    return provenance.partial &&
           std::any_of(provenance.notes.begin(), provenance.notes.end(),
                       [](const std::string& note) { return note.starts_with(living_note); });
}

// Returns a number that depends only on the cells. Of two equally good grids, these numbers decide
// which one stays.
std::uint64_t order_of(const grid::BrickView& view) {
    std::vector<std::uint64_t> words;
    for (const grid::BrickEntry& brick : view.bricks) {
        words.push_back(static_cast<std::uint64_t>(brick.kind));
        words.push_back(static_cast<std::uint64_t>(brick.uniform_status));
        words.push_back(brick.checksum);
    }
    return xxh3_64(std::as_bytes(std::span(words)));
}

constexpr std::chrono::minutes half_an_hour{30};

// The first radial that is received of a volume is at most this far from the time in the volume's
// header.
constexpr std::chrono::minutes farthest_radial{15};

struct RadialTimes {
    UtcTime first, last;
    static std::optional<RadialTimes> of(const level2::Volume& volume) {
        std::optional<RadialTimes> times;
        const std::optional<UtcTime> start = volume.start_time();
        for (const level2::Sweep& sweep : volume.sweeps) {
            for (const level2::Radial& radial : sweep.radials) {
                if (!level2::is_time_of_volume(radial.time, start)) continue;
                if (!times) times = RadialTimes{radial.time, radial.time};
                times->first = std::min(times->first, radial.time);
                times->last = std::max(times->last, radial.time);
            }
        }
        return times;
    }
    [[nodiscard]] bool has(const cache::GridDescription& grid) const {
        return grid.start_time >= first && grid.end_time <= last;
    }
};

}  // namespace

Result<std::optional<std::string>> reason_to_keep(const std::filesystem::path& path,
                                                  const Candidate& candidate) {
    const std::optional<std::string> none;
    const cache::GridDescription& made = candidate.description;
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return none;
    const auto file = cache::GridFile::open(path);
    if (!file && is_shortage(file.error().code)) return pass_on(file);
    if (!file) return none;
    const auto& stands = file->description();
    if (stands.spec != made.spec || stands.moment != made.moment) return none;
    const auto& old = stands.provenance;
    const bool stands_living = is_living(old);
    const bool made_living = is_living(made.provenance);
    if (stands_living && !made_living) return none;
    if (!stands_living && made_living)
        return std::optional<std::string>{"not replaced: the cache has a grid of the ended volume"};
    const bool better = !old.partial && made.provenance.partial;
    const bool worse = old.partial && !made.provenance.partial;
    if (better)
        return std::optional<std::string>{"not replaced: the cache has a grid of the whole volume"};
    if (worse || !candidate.has_rival || stands_living) return none;
    const bool later = stands.end_time > made.end_time;
    const bool before =
        stands.end_time == made.end_time && order_of(file->view()) < order_of(candidate.view);
    if (!later && !before) return none;
    return std::optional<std::string>{
        "not replaced: the cache has a grid of another file of this volume"};
}

bool has_an_hours_volumes(const cache::StoreReader& store, const std::string& domain,
                          level2::Moment moment, UtcTime time) {
    const auto near = store.list(domain, moment, time - half_an_hour, time + half_an_hour);
    return near && near->size() >= most_volumes_an_hour;
}

void keep_to_an_hours_volumes(cache::StoreWriter& store, const std::string& domain,
                              level2::Moment moment, UtcTime time) {
    auto near = store.list(domain, moment, time - half_an_hour, time + half_an_hour);
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
    const auto times = RadialTimes::of(volume);
    if (!level2::parse_chunk_name(source_file) || !volume.header || !times) return;
    const UtcTime time = volume.header->time();
    const auto near = store.list(domain, moment, time - farthest_radial, time + farthest_radial);
    if (!near) return;
    for (const cache::StoreEntry& entry : *near) {
        if (entry.time == time || entry.pinned) continue;
        const auto file = cache::GridFile::open(entry.path);
        if (!file || !file->description().provenance.partial) continue;
        if (times->has(file->description())) (void)store.remove(entry);
    }
}

}  // namespace stormcellar::pipeline
