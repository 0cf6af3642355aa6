#include "base/load_module.h"

#include <filesystem>
#include <vector>

#include <dlfcn.h>

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> places_of(const std::string& file, const std::string& room) {
    std::vector<fs::path> places;
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed).parent_path();
    if (!failed) {
        places.push_back(program / STORMCELLAR_MODULES_FROM_PROGRAM / file);
        places.push_back(program / ".." / room / file);
        places.push_back(program / "../.." / room / file);
    }
    places.push_back(fs::path{STORMCELLAR_MODULES} / file);
    return places;
}

}  // namespace

Result<void*> load_module(const std::string& file, const char* entry, const std::string& room) {
    std::string problem = fmt::format("{} is not installed", file);
    for (const fs::path& place : places_of(file, room)) {
        std::error_code ignored;
        if (!fs::exists(place, ignored)) continue;
        void* module = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* found = module != nullptr ? ::dlsym(module, entry) : nullptr;
        if (found != nullptr) return found;
        const char* reason = ::dlerror();
        problem = reason != nullptr ? reason : place.string();
    }
    return fail(ErrorCode::unsupported, "{}", problem);
}

}  // namespace stormcellar
