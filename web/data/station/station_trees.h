// web/data/station/station_trees.h -- a station's volumes as a tree over time, made from the
// catalog.
//
// Each scan pattern (VCP) of the station has its places (sweep_places.h). To learn the places, the
// newest and the oldest volume of each size are decoded. The first call for a station does this for
// all sizes, later calls only for new sizes. No other volume is decoded until its values are
// requested. The tree has the newest `most_volumes` complete and partial volumes, one for each
// start. The index of a volume along the time is its number in TimeNumbers. A volume keeps its
// number.
//
// Threads   Many threads may use one object.
// Errors    not_found: no catalog, no such station, or no volume that can be read; those of the
//           catalog, of TimeNumbers::update() and of DecodedVolumes.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/recently_used.h"
#include "base/steady_time.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/catalog/catalog.h"
#include "web/data/events/catalog_changes.h"
#include "web/data/raw/served_catalog.h"
#include "web/data/station/decoded_volumes.h"
#include "web/data/station/station_layout.h"
#include "web/data/station/sweep_places.h"
#include "web/data/zarr/time_numbers.h"

namespace stormcellar::web {

struct StationPattern {
    std::string name;  // "VCP-212", "VCP-unknown"
    std::shared_ptr<const SweepPlaces> places;
    std::shared_ptr<const std::vector<UtcTime>> times;  // starts by index
    std::map<UtcTime, catalog::CatalogEntry> volumes;   // by start

    // Returns the volume of an index, or null if it has left the catalog.
    [[nodiscard]] const catalog::CatalogEntry* volume_at(std::size_t index) const;
};

struct StationTree {
    ServedCatalog::Reader catalog;
    StationFacts facts;
    std::vector<StationPattern> patterns;
    ZarrTree groups;
};

struct StationTreesOptions {
    std::filesystem::path catalog;
    ServedCatalog::Reader reader = nullptr;  // the same catalog, if it is already open
    std::shared_ptr<TimeNumbers> numbers;
    std::uint64_t most_decoded_bytes = DecodedVolumes::usual_bytes;
    // How often to look for changes of the catalog.
    std::chrono::milliseconds look_every{1000};
};

// The sweep of a volume at a place; null: the volume has none.
struct FoundSweep {
    DecodedVolumes::Volume volume;
    const level2::Sweep* sweep = nullptr;
};

class StationTrees {
  public:
    using Tree = std::shared_ptr<const StationTree>;
    static constexpr std::size_t most_volumes = 100'000;
    // Limits of what a hostile archive can make the server learn of one station, and send as
    // metadata. Patterns beyond a limit are left out.
    static constexpr std::size_t most_patterns = 64, most_sizes = 64, most_groups = 2000;

    explicit StationTrees(StationTreesOptions options);

    // Returns the stations of the catalog, sorted. Errors: those of the catalog.
    [[nodiscard]] Result<std::vector<std::string>> stations();
    // Returns the tree if it was made after the last change of the station's catalog, else null.
    // Takes microseconds, and once for each `look_every` up to a millisecond.
    [[nodiscard]] Tree find_fresh(std::string_view station);
    // Returns the tree. May read the station's catalog and decode volumes.
    [[nodiscard]] Result<Tree> open(std::string_view station);
    // Returns the sweep of a volume at a place of the pattern. May decode the volume, or only the
    // records of this sweep.
    [[nodiscard]] Result<FoundSweep> find_sweep(const StationTree& tree,
                                                const StationPattern& pattern,
                                                const catalog::CatalogEntry& volume,
                                                std::size_t place);

  private:
    // What was learned of a pattern.
    struct Known {
        std::shared_ptr<const SweepPlaces> places = std::make_shared<SweepPlaces>();
        std::set<VolumeSize> sizes = {};
        std::optional<StationFacts> facts = {};
    };
    // Patterns by number; the unknown pattern comes last.
    using PatternKey = std::pair<bool, int>;
    using Volumes = std::map<UtcTime, catalog::CatalogEntry>;
    struct Station {
        Mutex making;  // one thread at a time makes the tree
        std::map<PatternKey, Known> known STORMCELLAR_GUARDED_BY(making);
        Mutex mutex;
        std::uint64_t changes STORMCELLAR_GUARDED_BY(mutex) = 1;  // of the catalog
        std::uint64_t changes_in_tree STORMCELLAR_GUARDED_BY(mutex) = 0;
        Tree tree STORMCELLAR_GUARDED_BY(mutex);
    };

    [[nodiscard]] std::shared_ptr<Station> known_station(std::string_view station);
    void look_for_changes();
    [[nodiscard]] static Tree fresh_tree(Station& station);
    [[nodiscard]] Result<Tree> make(const ServedCatalog::Reader& catalog, std::string_view station,
                                    std::map<PatternKey, Known>& known);
    void learn(const catalog::CatalogReader& catalog, const Volumes& volumes, Known& known);
    [[nodiscard]] Result<DecodedVolumes::Volume> decoded(const catalog::CatalogReader& catalog,
                                                         const catalog::CatalogEntry& volume);

    const StationTreesOptions options_;
    ServedCatalog catalog_;
    DecodedVolumes decoded_;
    Mutex mutex_;
    CatalogChanges changes_ STORMCELLAR_GUARDED_BY(mutex_);
    std::optional<SteadyTime> looked_ STORMCELLAR_GUARDED_BY(mutex_);
    RecentlyUsed<std::string, std::shared_ptr<Station>> stations_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
