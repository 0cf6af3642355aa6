// Loads the module that fetches, stormcellar_fetch.so, when something is to be fetched: libcurl
// brings two dozen libraries, which no other command is to start with.
#include "fetch/fetch.h"

#include <dlfcn.h>

namespace stormcellar::fetch {
namespace {

namespace fs = std::filesystem;

// Installed with this program, wherever that was moved; in the tree that it was built in; where it
// was to be installed.
std::vector<fs::path> places() {
    std::vector<fs::path> places;
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed).parent_path();
    if (!failed) {
        for (const char* folder : {STORMCELLAR_MODULES_FROM_PROGRAM, "../fetch", "../../fetch"})
            places.push_back(program / folder / fetch_module_file);
    }
    places.push_back(fs::path{STORMCELLAR_MODULES} / fetch_module_file);
    return places;
}

Result<FetchEntry> load() {
    std::string problem = fmt::format("{} is not installed", fetch_module_file);
    for (const fs::path& place : places()) {
        std::error_code ignored;
        if (!fs::exists(place, ignored)) continue;
        void* module = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* found = module != nullptr ? ::dlsym(module, fetch_module_entry) : nullptr;
        if (found != nullptr) return reinterpret_cast<FetchEntry>(found);
        const char* reason = ::dlerror();
        problem = reason != nullptr ? reason : place.string();
    }
    return fail(ErrorCode::unsupported, "the module that fetches cannot be loaded: {}", problem);
}

}  // namespace

Result<FetchReport> fetch(const FetchRequest& request) {
    static const Result<FetchEntry> entry = load();
    if (!entry) return pass_on(entry);
    Result<FetchReport> report;
    (*entry)(request, report);
    return report;
}

}  // namespace stormcellar::fetch
