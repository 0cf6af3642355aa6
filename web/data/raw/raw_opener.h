// web/data/raw/raw_opener.h -- opens raw files of the catalog, to serve them. Only the code for the
// raw files of the catalog uses it (raw_files.h).
//
// Threads   Many threads may use one object.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <sys/stat.h>

#include "base/recently_used.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/catalog/catalog.h"
#include "web/data/raw/raw_files.h"

namespace stormcellar::web {

// An open file: a file of the catalog, or the joined chunks of a volume.
struct OpenedRaw {
    std::shared_ptr<const Descriptor> file;
    std::uint64_t size_bytes = 0;
    UtcTime modified{};
    std::string tag;
    bool is_joined = false;  // a nameless file, which takes space while it is open
};
using OpenedRawOrMissing = tl::expected<OpenedRaw, RawFailure>;

// The size, time and tag of a volume, taken from its rows without opening a file. A growing file
// has no tag, but the chunks of a growing volume have one.
struct RawFacts {
    std::uint64_t size_bytes = 0;
    UtcTime modified{};
    std::string tag;
};

class RawOpener {
  public:
    RawOpener(std::filesystem::path scratch, std::size_t most_joined,
              std::uint64_t most_joined_bytes)
        : scratch_(std::move(scratch)),
          budget_{.weight = most_joined_bytes, .values = most_joined},
          joined_(budget_) {}

    [[nodiscard]] OpenedRawOrMissing open(const catalog::CatalogReader& catalog,
                                          const catalog::CatalogEntry& entry);
    [[nodiscard]] Result<RawFacts> facts_of(const catalog::CatalogReader& catalog,
                                            const catalog::CatalogEntry& entry);

  private:
    // Identifies a state of a file's contents. The kernel changes ctime whenever the contents
    // change.
    using State = std::tuple<dev_t, ino_t, off_t, std::int64_t, std::int64_t>;
    static State state_of(const struct stat& facts);
    [[nodiscard]] Status check_hash(const catalog::CatalogEntry& entry, const Descriptor& file,
                                    const struct stat& facts);
    [[nodiscard]] OpenedRawOrMissing open_chunks(const catalog::CatalogReader& catalog,
                                                 const catalog::CatalogEntry& entry);
    [[nodiscard]] OpenedRawOrMissing join(const catalog::CatalogReader& catalog,
                                          const std::vector<catalog::CatalogEntry>& chunks,
                                          bool grows) const;
    [[nodiscard]] std::optional<OpenedRaw> find_joined(const std::string& key);
    void keep_joined(const std::string& key, const OpenedRaw& joined);
    void remember_facts(const catalog::CatalogEntry& entry, const RawFacts& facts);

    const std::filesystem::path scratch_;
    const KeptBudget budget_;  // limits joined_
    Mutex mutex_;
    std::map<State, std::uint64_t> hashes_ STORMCELLAR_GUARDED_BY(mutex_);
    RecentlyUsed<std::string, OpenedRaw> joined_ STORMCELLAR_GUARDED_BY(mutex_);
    // Facts of volumes in chunks that no longer grow.
    std::map<std::string, RawFacts> facts_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
