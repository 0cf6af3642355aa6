// web/doors/viewer/viewer_files.h -- the files of the viewer (viewer/), linked into the program.
#pragma once

#include <span>
#include <string_view>

namespace stormcellar::web {

struct ViewerFile {
    std::string_view name;  // "index.html"
    std::string_view media_type;
    std::string_view bytes;
};

// Returns the files; empty if the program was built without the viewer.
[[nodiscard]] std::span<const ViewerFile> viewer_files();

}  // namespace stormcellar::web
