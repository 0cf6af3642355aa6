// Loads the module of videos, stormcellar_video.so, the first time one is written. It stays: FFmpeg
// is not made to be unloaded.
#include <string>

#include <dlfcn.h>

#include "render/animation/animation_format.h"

namespace stormcellar::render {
namespace {

namespace fs = std::filesystem;

// Where it may lie: installed with this program, wherever that was moved; in the tree that this
// program was built in; where it was to be installed. Not along a path of the loader: that would be
// searched for every library of the program.
std::vector<fs::path> places() {
    std::vector<fs::path> places;
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed).parent_path();
    if (!failed) {
        for (const char* folder : {STORMCELLAR_MODULES_FROM_PROGRAM, "../render", "../../render"})
            places.push_back(program / folder / video_module_file);
    }
    places.push_back(fs::path{STORMCELLAR_MODULES} / video_module_file);
    return places;
}

struct Entry {
    MakeVideoEncoder make = nullptr;
    std::string problem;
};

Entry load() {
    Entry entry;
    entry.problem = fmt::format("{} is not installed", video_module_file);
    for (const fs::path& place : places()) {
        std::error_code ignored;
        if (!fs::exists(place, ignored)) continue;
        void* module = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* found = module != nullptr ? ::dlsym(module, video_module_entry) : nullptr;
        if (found != nullptr) {
            entry.make = reinterpret_cast<MakeVideoEncoder>(found);
            return entry;
        }
        const char* reason = ::dlerror();
        entry.problem = reason != nullptr ? reason : place.string();
    }
    return entry;
}

}  // namespace

Result<std::unique_ptr<FrameEncoder>> make_video_encoder(VideoContainer container,
                                                         const AnimationOptions& options) {
    static const Entry entry = load();
    if (entry.make == nullptr) {
        return fail(ErrorCode::unsupported, "the module that writes videos cannot be loaded: {}",
                    entry.problem);
    }
    return std::unique_ptr<FrameEncoder>(entry.make(container, options));
}

}  // namespace stormcellar::render
