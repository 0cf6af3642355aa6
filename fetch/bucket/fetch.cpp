// Loads the download module, stormcellar_fetch.so, when it is first needed. Other commands do not
// load it: libcurl needs two dozen libraries, which would slow down their start.
#include "stormcellar/fetch/fetch.h"

#include "base/load_module.h"

namespace stormcellar::fetch {

Result<FetchReport> fetch(const FetchRequest& request) {
    static const Result<void*> entry =
        load_module(fetch_module_file, fetch_module_entry, "fetch/bucket");
    if (!entry) {
        return fail(entry.error().code, "the module that fetches cannot be loaded: {}",
                    entry.error().message);
    }
    Result<FetchReport> report;
    reinterpret_cast<FetchEntry> (*entry)(request, report);
    return report;
}

}  // namespace stormcellar::fetch
