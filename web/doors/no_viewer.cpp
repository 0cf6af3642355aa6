#include "web/doors/viewer_files.h"

namespace stormcellar::web {

std::span<const ViewerFile> viewer_files() {
    return {};
}

}  // namespace stormcellar::web
