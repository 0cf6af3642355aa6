// web/data/station/decoded_volumes.h -- decodes cataloged volumes, and keeps the last ones.
//
// Threads   Many threads may use it. If several want the same volume at the same time, one decodes
//           it and the others wait.
// Errors    Those of read_cataloged_volume() and decode(). corrupt: the file does not hold the
//           volume that the catalog says.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/recently_used.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::web {

// A volume of the catalog. The key changes when its file changes.
struct VolumeToDecode {
    const catalog::CatalogReader& catalog;
    const catalog::CatalogEntry& entry;
    std::string key;
};
// Makes the key. Errors: those of the catalog.
[[nodiscard]] Result<std::string> key_of_volume(const catalog::CatalogReader& catalog,
                                                const catalog::CatalogEntry& entry);

class DecodedVolumes {
  public:
    using Volume = std::shared_ptr<const level2::Volume>;
    static constexpr std::uint64_t usual_bytes = std::uint64_t{128} << 20;
    static constexpr std::size_t most_volumes = 256;  // also counts single sweeps

    // The budget is of the volumes that are kept. One more of at most `most_volume_bytes` is in
    // memory for each thread that decodes.
    static constexpr std::uint64_t most_volume_bytes = std::uint64_t{256} << 20;
    explicit DecodedVolumes(std::uint64_t budget_bytes = usual_bytes)
        : kept_({.weight = budget_bytes, .values = most_volumes}) {}

    // Returns the volume if it is kept, else null. Waits if it is being decoded.
    [[nodiscard]] Volume find(const VolumeToDecode& wanted);
    [[nodiscard]] Result<Volume> find_or_decode(const VolumeToDecode& wanted);
    // Returns a volume that has only the sweep of this elevation number. Decodes only the records
    // that hold it. Returns null if that is impossible, because the file has no such records or no
    // single sweep of this number.
    [[nodiscard]] Result<Volume> find_or_decode_cut(const VolumeToDecode& wanted,
                                                    int elevation_number);

  private:
    struct Held {
        Mutex mutex;
        bool is_decoded STORMCELLAR_GUARDED_BY(mutex) = false;
        Volume volume STORMCELLAR_GUARDED_BY(mutex);
    };
    [[nodiscard]] std::shared_ptr<Held> held(const std::string& key);
    [[nodiscard]] Result<Volume> found_or_made(const std::string& key,
                                               const std::function<Result<Volume>()>& make);

    Mutex mutex_;
    RecentlyUsed<std::string, std::shared_ptr<Held>> kept_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
