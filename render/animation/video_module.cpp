// Loads the module for videos, stormcellar_video.so, when the first video is written. The module
// stays loaded, because FFmpeg is not made to be unloaded.
#include "base/load_module.h"
#include "render/animation/animation_format.h"

namespace stormcellar::render {

Result<std::unique_ptr<FrameEncoder>> make_video_encoder(VideoContainer container,
                                                         const AnimationOptions& options) {
    static const Result<void*> entry = load_module(video_module_file, video_module_entry, "render");
    if (!entry) {
        return fail(ErrorCode::unsupported, "the module that writes videos cannot be loaded: {}",
                    entry.error().message);
    }
    const auto make = reinterpret_cast<MakeVideoEncoder>(*entry);
    return std::unique_ptr<FrameEncoder>(make(container, options));
}

}  // namespace stormcellar::render
