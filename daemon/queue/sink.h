// daemon/queue/sink.h -- the interface through which the service processes files. Tests implement
// it to test the service without radar data. Thread contract: several workers call take() at once,
// but never for the same path.
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
    // Stations whose databases cannot be used now, and why. The database for files of unknown
    // stations has an empty name here.
    std::vector<std::pair<std::string, std::string>> troubles;
    std::string rule;                  // "known", "any" or "listed"
    std::vector<std::string> further;  // other stations that the rule "any" has accepted
    std::size_t most_further = 0;      // limit of `further`
    // Databases whose stations the rule does not accept: their number, and the first names.
    std::size_t left_alone = 0;
    std::vector<std::string> some_left_alone;
    bool operator==(const CatalogState&) const = default;
};

// The result of a roll of the cache (an eviction down to the budgets), and what the cache then
// holds, if that is known.
struct CacheRolled {
    cache::RollReport report;
    std::optional<cache::StoreUsage> usage;
};

class Sink : public Interface {
  public:
    // Ingests a file. If the file is faulty, the outcome is `rejected`. An error means that the
    // file could not be ingested for another reason (for example, the catalog or the cache cannot
    // be written), and should be tried again. If `tries` says that this is the last attempt,
    // rejects the file instead, provided that the rejection can be stored.
    virtual Result<Taken> take(const std::filesystem::path& path, bool finish_as_is,
                               pipeline::Tries tries) = 0;
    // Returns the files that were being ingested when the process last ended, and how long each
    // must wait.
    [[nodiscard]] virtual std::map<std::filesystem::path, std::chrono::seconds> waits() const {
        return {};
    }
    // Handles a file that must wait, without reading it. Registers the file in the catalog. If the
    // file does not exist, marks its rows as gone. Returns `gone` if nothing is left to do, else
    // `stands`: the file must still be ingested. A missing file must also be ingested if chunks of
    // a volume wait for it. May run beside take() for other paths.
    virtual Result<pipeline::Noted> note(const std::filesystem::path& /*path*/) {
        return pipeline::Noted::stands;
    }
    // Says how much work waits. Optional work is left out accordingly.
    virtual void set_load(pipeline::Load /*load*/) {}
    // Long functions call this now and then, from their own thread, to show that they make
    // progress.
    using OnStep = std::function<void()>;
    // Marks known files that no longer exist as gone, and returns the number of these files. Call
    // after a scan. May run beside take().
    virtual Result<int> mark_missing(const OnStep& step) = 0;
    // Deletes the rows of gone files that were last registered before `before`, and returns their
    // number. May run beside take().
    virtual Result<int> forget_gone(UtcTime /*before*/, const OnStep& /*step*/) { return 0; }
    // Deletes the oldest rows of gone files if all rows exceed their limit. Returns the number of
    // deleted rows. May run beside take().
    virtual Result<std::int64_t> roll_rows(const OnStep& /*step*/) { return 0; }
    // Returns the present state of the catalog. May be called beside the other functions.
    [[nodiscard]] virtual CatalogState catalog_state() { return {}; }
    // Sets the budgets of the cache and brings the cache within them. May run beside take(); one
    // call at a time.
    virtual CacheRolled roll_cache(const cache::Budgets& /*budgets*/, const OnStep& /*step*/) {
        return {};
    }
    // Returns an error if the catalog or the cache cannot be written now. The service calls it
    // until it succeeds once.
    [[nodiscard]] virtual Status can_store() { return {}; }
    // Returns one printable line for each damage that was found and repaired since the last call.
    // If there are any, all files of the drop directory must be offered again. May be called beside
    // the other functions.
    virtual std::vector<std::string> take_repairs() { return {}; }
};

}  // namespace stormcellar::daemon
