// daemon/queue/sink.h -- what the service does with a file: one call, so that the service can be
// tested without radar data. Thread contract: take() is called by several workers at once, never
// twice at a time for one path.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/watch/file_stamp.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::daemon {

struct Taken {
    FileStamp stamp;  // of the file before it was read
    pipeline::IngestOutcome ingest;
};

// How the catalog stands.
struct CatalogState {
    // Databases that cannot be used now, and why; the station is empty for that of files without.
    std::vector<std::pair<std::string, std::string>> troubles;
    std::string rule;                  // "known", "any" or "listed"
    std::vector<std::string> further;  // stations that `any` admitted
    std::size_t most_further = 0;
    // Databases of stations that are not known, and the first names of them.
    std::size_t left_alone = 0;
    std::vector<std::string> some_left_alone;
    bool operator==(const CatalogState&) const = default;
};

// What a roll of the cache did, and what it holds now; no usage where the cache keeps no budget.
struct CacheRolled {
    cache::RollReport report;
    std::optional<cache::StoreUsage> usage;
};

class Sink {
  public:
    Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    virtual ~Sink() = default;

    // An error is ours alone (catalog or cache cannot be written): the file is tried again later.
    // After the last try it is rejected, with its reason, where that can be stored.
    virtual Result<Taken> take(const std::filesystem::path& path, bool finish_as_is,
                               pipeline::Tries tries) = 0;
    // For one that has to wait: writes the file into the catalog as it is there, unread
    // (stands), or marks its rows when it is gone (gone: there is nothing left to do). May run
    // beside take() of other paths.
    virtual Result<pipeline::Noted> note(const std::filesystem::path& /*path*/) {
        return pipeline::Noted::stands;
    }
    // Whether more waits than workers can soon take: what may be left out is left out.
    virtual void set_pressed(bool /*pressed*/) {}
    // Called now and then by what may last long, from its own thread: it moves on.
    using OnStep = std::function<void()>;
    // Marks what is known and no longer there, as after a scan; gives how much. May run beside
    // take().
    virtual Result<int> mark_missing(const OnStep& step) = 0;
    // Deletes what is known of files that are gone and were last registered before that time; gives
    // how many. May run beside take().
    virtual Result<int> forget_gone(UtcTime /*before*/, const OnStep& /*step*/) { return 0; }
    // Deletes rows of files that are gone where they take more than they may; gives how many. May
    // run beside take().
    virtual Result<std::int64_t> roll_rows(const OnStep& /*step*/) { return 0; }
    // How the catalog stands now. May be called beside the others.
    [[nodiscard]] virtual CatalogState catalog_state() { return {}; }
    // Keeps the cache within these budgets from now on. May run beside take(); one at a time.
    virtual CacheRolled roll_cache(const cache::Budgets& /*budgets*/, const OnStep& /*step*/) {
        return {};
    }
    // Whether catalog and cache can be written now; asked until it was so once.
    [[nodiscard]] virtual Status can_store() { return {}; }
    // What was found damaged and put right since the last call, one line each, fit for the log. The
    // files of the drop directory must then be offered again. May be called beside the others.
    virtual std::vector<std::string> take_repairs() { return {}; }
};

}  // namespace stormcellar::daemon
