// daemon/queue/sink.h -- processes files for the service, as an interface, so that the service can
// be tested without radar data. Thread contract: several workers call take() at once, but never for
// the same path.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/watch/file_stamp.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/interface.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::daemon {

struct Taken {
    FileStamp stamp;  // the file's stamp from before it was read
    pipeline::IngestOutcome ingest;
};

// The state of the catalog.
struct CatalogState {
    // Databases that cannot be used now, and why; for the database of files of no known station the
    // station is empty.
    std::vector<std::pair<std::string, std::string>> troubles;
    std::string rule;                  // "known", "any" or "listed"
    std::vector<std::string> further;  // stations that `any` accepted
    std::size_t most_further = 0;
    // Number of databases of unknown stations, and the first names.
    std::size_t left_alone = 0;
    std::vector<std::string> some_left_alone;
    bool operator==(const CatalogState&) const = default;
};

// The result of a roll of the cache, and the cache's contents; no usage if the cache has no limits.
struct CacheRolled {
    cache::RollReport report;
    std::optional<cache::StoreUsage> usage;
};

class Sink : public Interface {
  public:
    // Ingests a file. An error is never the file's fault (the catalog or the cache cannot be
    // written); the file is tried again later. After the last try the file is rejected with the
    // reason, if that can be stored.
    virtual Result<Taken> take(const std::filesystem::path& path, bool finish_as_is,
                               pipeline::Tries tries) = 0;
    // Returns the files that were being ingested when the process last ended, and how long each has
    // to wait.
    [[nodiscard]] virtual std::map<std::filesystem::path, std::chrono::seconds> waits() const {
        return {};
    }
    // Handles a file that must wait: writes it into the catalog unread (stands), or marks its rows
    // if it is gone (gone; then nothing is left to do). May run beside take() for other paths.
    virtual Result<pipeline::Noted> note(const std::filesystem::path& /*path*/) {
        return pipeline::Noted::stands;
    }
    // Says whether more files wait than the workers can soon ingest; then optional work is left
    // out.
    virtual void set_pressed(bool /*pressed*/) {}
    // Long functions call this now and then, from the thread that runs them, to show progress.
    using OnStep = std::function<void()>;
    // Marks known files that no longer exist, after a scan. Returns how many. May run beside
    // take().
    virtual Result<int> mark_missing(const OnStep& step) = 0;
    // Deletes rows of files that are gone and were last registered before that time. Returns how
    // many. May run beside take().
    virtual Result<int> forget_gone(UtcTime /*before*/, const OnStep& /*step*/) { return 0; }
    // Deletes rows of files that are gone if the rows exceed their limit. Returns how many. May run
    // beside take().
    virtual Result<std::int64_t> roll_rows(const OnStep& /*step*/) { return 0; }
    // Returns the present state of the catalog. May be called beside the other functions.
    [[nodiscard]] virtual CatalogState catalog_state() { return {}; }
    // Keeps the cache within these limits from now on. May run beside take(); one call at a time.
    virtual CacheRolled roll_cache(const cache::Budgets& /*budgets*/, const OnStep& /*step*/) {
        return {};
    }
    // Returns an error if the catalog or the cache cannot be written now. Called until it succeeds
    // once.
    [[nodiscard]] virtual Status can_store() { return {}; }
    // Returns what was found damaged and repaired since the last call, one printable line each. The
    // files of the drop directory must then be offered again. May be called beside the other
    // functions.
    virtual std::vector<std::string> take_repairs() { return {}; }
};

}  // namespace stormcellar::daemon
