#include "web/doors/viewer/viewer_files.h"

namespace stormcellar::web {

std::span<const ViewerFile> viewer_files() {
    return {};
}

}  // namespace stormcellar::web
