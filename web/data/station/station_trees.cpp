#include "web/data/station/station_trees.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "stormcellar/base/station_table.h"

namespace stormcellar::web {
namespace {

using catalog::CatalogEntry;
using catalog::FileState;

// Limits of the trees that are kept: their volumes and their number.
constexpr KeptBudget kept_trees{.weight = 200'000, .values = 256};
constexpr std::size_t tries = 3;  // files that may fail before a size is given up

VolumeSize size_of(const CatalogEntry& volume) {
    return size_of_volume(volume.volume.sweep_count, volume.volume.radial_count);
}

bool has_values(const CatalogEntry& entry) {
    return (entry.state == FileState::complete || entry.state == FileState::partial) &&
           entry.volume.sweep_count > 0 && entry.volume.start_time;
}

bool is_better(const CatalogEntry& a, const CatalogEntry& b) {
    return std::pair(a.volume.complete, a.volume.radial_count) >
           std::pair(b.volume.complete, b.volume.radial_count);
}

// Returns the volumes that can be read, one for each start, because a volume may come in several
// files.
std::map<UtcTime, CatalogEntry> one_of_each_start(std::vector<CatalogEntry> entries) {
    std::map<UtcTime, CatalogEntry> best;
    for (CatalogEntry& entry : entries) {
        if (!has_values(entry)) continue;
        const auto [known, is_new] = best.try_emplace(*entry.volume.start_time, entry);
        if (!is_new && is_better(entry, known->second)) known->second = std::move(entry);
    }
    return best;
}

// Returns the volumes to learn from, by size, the largest first, each by start. Incomplete volumes
// count only if there are no complete volumes.
using BySize = std::map<VolumeSize, std::vector<const CatalogEntry*>, std::greater<>>;
BySize by_size(const std::map<UtcTime, CatalogEntry>& volumes) {
    const bool any_complete =
        std::ranges::any_of(volumes, [](const auto& one) { return one.second.volume.complete; });
    BySize sizes;
    for (const auto& [start, volume] : volumes)
        if (volume.volume.complete || !any_complete) sizes[size_of(volume)].push_back(&volume);
    return sizes;
}

void add_pattern(StationTree& tree, StationPattern pattern) {
    tree.groups.emplace_back(pattern.name, ZarrGroup{});
    const auto& places = pattern.places->all();
    for (std::size_t i = 0; i < places.size(); ++i)
        tree.groups.emplace_back(fmt::format("{}/sweep_{}", pattern.name, i),
                                 zarr_group_of(places[i], pattern.times->size()));
    tree.patterns.push_back(std::move(pattern));
}

}  // namespace

const CatalogEntry* StationPattern::volume_at(std::size_t index) const {
    if (index >= times->size()) return nullptr;
    const auto found = volumes.find((*times)[index]);
    return found == volumes.end() ? nullptr : &found->second;
}

StationTrees::StationTrees(StationTreesOptions options)
    : options_(std::move(options)),
      catalog_(options_.catalog, options_.reader),
      decoded_(options_.most_decoded_bytes),
      changes_(options_.catalog),
      stations_(kept_trees) {}

Result<std::vector<std::string>> StationTrees::stations() {
    const auto catalog = catalog_.get();
    if (!catalog && catalog.error().code == ErrorCode::not_found) return std::vector<std::string>{};
    if (!catalog) return pass_on(catalog);
    auto names = (*catalog)->station_names();
    if (names) std::erase(*names, std::string{});  // the database of unknown stations
    return names;
}

void StationTrees::look_for_changes() {
    const MutexLock lock(mutex_);
    const SteadyTime now = steady_now();
    if (looked_ && now - *looked_ < options_.look_every) return;
    looked_ = now;
    for (const std::string& name : changes_.take()) {
        if (const auto* station = stations_.find(name)) {
            const MutexLock station_lock((*station)->mutex);
            ++(*station)->changes;
        }
    }
}

std::shared_ptr<StationTrees::Station> StationTrees::known_station(std::string_view station) {
    const MutexLock lock(mutex_);
    const auto* known = stations_.find(std::string(station));
    return known == nullptr ? nullptr : *known;
}

StationTrees::Tree StationTrees::fresh_tree(Station& station) {
    const MutexLock lock(station.mutex);
    return station.changes == station.changes_in_tree ? station.tree : nullptr;
}

StationTrees::Tree StationTrees::find_fresh(std::string_view station) {
    look_for_changes();
    const auto known = known_station(station);
    return known ? fresh_tree(*known) : nullptr;
}

Result<StationTrees::Tree> StationTrees::open(std::string_view station) {
    if (!is_icao(station)) return fail(ErrorCode::not_found, "there is no such station");
    look_for_changes();
    const auto catalog = catalog_.get();
    if (!catalog) return pass_on(catalog);
    auto known = known_station(station);
    if (!known) {
        // Keep nothing for names that the catalog does not have.
        const auto latest = (*catalog)->latest(station);
        if (!latest) return pass_on(latest);
        if (!*latest) return fail(ErrorCode::not_found, "there are no volumes of {}", station);
        const MutexLock lock(mutex_);
        const auto* other = stations_.find(std::string(station));
        known = other != nullptr
                    ? *other
                    : stations_.keep(std::string(station), std::make_shared<Station>());
    }
    const MutexLock making(known->making);
    if (Tree fresh = fresh_tree(*known)) return fresh;
    std::uint64_t changes = 0;
    {
        const MutexLock lock(known->mutex);
        changes = known->changes;
    }
    auto tree = make(*catalog, station, known->known);
    if (!tree) return tree;
    std::size_t count = 1;
    for (const StationPattern& pattern : (*tree)->patterns)
        count += pattern.volumes.size();
    {
        const MutexLock lock(known->mutex);
        known->tree = *tree;
        known->changes_in_tree = changes;
    }
    const MutexLock lock(mutex_);
    stations_.keep(std::string(station), known, count);
    return tree;
}

Result<StationTrees::Tree> StationTrees::make(const ServedCatalog::Reader& catalog,
                                              std::string_view station,
                                              std::map<PatternKey, Known>& known) {
    catalog::Query query;
    query.newest = most_volumes;
    auto entries = catalog->list(station, query);
    if (!entries) return pass_on(entries);
    std::map<PatternKey, Volumes> by_pattern;
    for (auto& [start, volume] : one_of_each_start(std::move(*entries))) {
        const PatternKey key{!volume.volume.vcp, volume.volume.vcp.value_or(0)};
        if (!by_pattern.contains(key) && by_pattern.size() == most_patterns) continue;
        by_pattern[key].emplace(start, std::move(volume));
    }
    auto tree = std::make_shared<StationTree>();
    tree->catalog = catalog;
    tree->groups.emplace_back(std::string{}, ZarrGroup{});
    for (auto& [key, volumes] : by_pattern) {
        Known& of_pattern = known[key];
        learn(*catalog, volumes, of_pattern);
        if (!of_pattern.facts) continue;  // no file could be read
        if (tree->groups.size() + of_pattern.places->all().size() > most_groups) continue;
        StationPattern pattern{
            .name = key.first ? std::string{"VCP-unknown"} : fmt::format("VCP-{}", key.second),
            .places = of_pattern.places,
            .times = nullptr,
            .volumes = std::move(volumes)};
        std::vector<UtcTime> starts;
        for (const auto& [start, volume] : pattern.volumes)
            starts.push_back(start);
        auto times = options_.numbers->update(station, pattern.name, starts);
        if (!times) return pass_on(times);
        pattern.times = std::move(*times);
        tree->facts = *of_pattern.facts;
        add_pattern(*tree, std::move(pattern));
    }
    if (tree->patterns.empty())
        return fail(ErrorCode::not_found, "the catalog has no volume of {} that can be read",
                    station);
    tree->groups.front().second = zarr_root_of(tree->facts);
    return Tree{std::move(tree)};
}

// Learns from the newest and the oldest volume of each new size, because these two may differ in
// gates and moments. If a file cannot be read, takes the next one. If no file of a size can be
// read, the next call tries this size again.
void StationTrees::learn(const catalog::CatalogReader& catalog, const Volumes& volumes,
                         Known& known) {
    auto places = std::make_shared<SweepPlaces>(*known.places);
    const auto learn_from = [&](const CatalogEntry& volume) {
        const auto one = decoded(catalog, volume);
        if (!one) return false;
        if (!known.facts) known.facts = station_facts_of(**one);
        places->learn(**one, size_of(volume));
        return true;
    };
    for (const auto& [size, some] : by_size(volumes)) {
        if (known.sizes.contains(size) || known.sizes.size() == most_sizes) continue;
        bool is_learned = false;
        for (std::size_t i = 0; i < std::min(tries, some.size()) && !is_learned; ++i)
            is_learned = learn_from(*some[some.size() - 1 - i]);
        if (!is_learned) continue;
        known.sizes.insert(size);
        for (std::size_t i = 0; i < std::min(tries, some.size() - 1); ++i)
            if (learn_from(*some[i])) break;
    }
    known.places = std::move(places);
}

Result<DecodedVolumes::Volume> StationTrees::decoded(const catalog::CatalogReader& catalog,
                                                     const CatalogEntry& volume) {
    auto key = key_of_volume(catalog, volume);
    if (!key) return pass_on(key);
    return decoded_.find_or_decode({catalog, volume, std::move(*key)});
}

Result<FoundSweep> StationTrees::find_sweep(const StationTree& tree, const StationPattern& pattern,
                                            const CatalogEntry& volume, std::size_t place) {
    const auto key = key_of_volume(*tree.catalog, volume);
    if (!key) return pass_on(key);
    const VolumeToDecode wanted{*tree.catalog, volume, *key};
    const SweepPlaces& places = *pattern.places;
    auto whole = decoded_.find(wanted);
    const auto cut = places.cut_of(size_of(volume), place);
    if (!whole && cut && volume.volume.complete && volume.number_in_file == 1) {
        auto part = decoded_.find_or_decode_cut(wanted, *cut);
        if (!part) return pass_on(part);
        if (*part && places.is_of_place((*part)->sweeps.front(), place)) {
            const level2::Sweep* const sweep = &(*part)->sweeps.front();
            return FoundSweep{std::move(*part), sweep};
        }
    }
    if (!whole) {
        auto decoded = decoded_.find_or_decode(wanted);
        if (!decoded) return pass_on(decoded);
        whole = std::move(*decoded);
    }
    const level2::Sweep* const sweep = places.find(*whole, place);
    return FoundSweep{std::move(whole), sweep};
}

}  // namespace stormcellar::web
