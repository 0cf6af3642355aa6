#include "web/doors/viewer/viewer_files.h"

#include <array>

#include "web/doors/embedded_file.h"

STORMCELLAR_EMBED(viewer_page, STORMCELLAR_VIEWER_PAGE "/index.html");
STORMCELLAR_EMBED(viewer_style, STORMCELLAR_VIEWER_PAGE "/viewer.css");
STORMCELLAR_EMBED(viewer_program, STORMCELLAR_VIEWER_MADE "/viewer.js");
STORMCELLAR_EMBED(viewer_editor, STORMCELLAR_VIEWER_MADE "/editor.js");
STORMCELLAR_EMBED(viewer_layers, STORMCELLAR_VIEWER_MADE "/layers.js");
STORMCELLAR_EMBED(viewer_map, STORMCELLAR_VIEWER_MADE "/map.js");
STORMCELLAR_EMBED(viewer_panels, STORMCELLAR_VIEWER_MADE "/panels.js");
STORMCELLAR_EMBED(viewer_worker, STORMCELLAR_VIEWER_MADE "/worker.js");

namespace stormcellar::web {

std::span<const ViewerFile> viewer_files() {
    constexpr std::string_view script = "text/javascript; charset=utf-8";
    static const std::array files{
        ViewerFile{"index.html", "text/html; charset=utf-8", STORMCELLAR_EMBEDDED(viewer_page)},
        ViewerFile{"viewer.css", "text/css; charset=utf-8", STORMCELLAR_EMBEDDED(viewer_style)},
        ViewerFile{"viewer.js", script, STORMCELLAR_EMBEDDED(viewer_program)},
        ViewerFile{"editor.js", script, STORMCELLAR_EMBEDDED(viewer_editor)},
        ViewerFile{"layers.js", script, STORMCELLAR_EMBEDDED(viewer_layers)},
        ViewerFile{"map.js", script, STORMCELLAR_EMBEDDED(viewer_map)},
        ViewerFile{"panels.js", script, STORMCELLAR_EMBEDDED(viewer_panels)},
        ViewerFile{"worker.js", script, STORMCELLAR_EMBEDDED(viewer_worker)},
    };
    return files;
}

}  // namespace stormcellar::web
