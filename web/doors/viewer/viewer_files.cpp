// Holds the bytes of the viewer's files, which the assembler includes.
#include "web/doors/viewer/viewer_files.h"

#include <array>

// clang-format off
#define STORMCELLAR_VIEWER_FILE(name, path)       \
    asm(".pushsection .rodata\n"                  \
        ".hidden stormcellar_" name "_begin\n"    \
        ".globl stormcellar_" name "_begin\n"     \
        "stormcellar_" name "_begin:\n"           \
        ".incbin \"" path "\"\n"                  \
        ".hidden stormcellar_" name "_end\n"      \
        ".globl stormcellar_" name "_end\n"       \
        "stormcellar_" name "_end:\n"             \
        ".byte 0\n"                               \
        ".popsection\n")
// clang-format on

STORMCELLAR_VIEWER_FILE("viewer_index_html", STORMCELLAR_VIEWER_PAGE "/index.html");
STORMCELLAR_VIEWER_FILE("viewer_viewer_css", STORMCELLAR_VIEWER_PAGE "/viewer.css");
STORMCELLAR_VIEWER_FILE("viewer_viewer_js", STORMCELLAR_VIEWER_MADE "/viewer.js");
STORMCELLAR_VIEWER_FILE("viewer_editor_js", STORMCELLAR_VIEWER_MADE "/editor.js");
STORMCELLAR_VIEWER_FILE("viewer_worker_js", STORMCELLAR_VIEWER_MADE "/worker.js");

extern "C" {
extern const char stormcellar_viewer_index_html_begin[], stormcellar_viewer_index_html_end[];
extern const char stormcellar_viewer_viewer_css_begin[], stormcellar_viewer_viewer_css_end[];
extern const char stormcellar_viewer_viewer_js_begin[], stormcellar_viewer_viewer_js_end[];
extern const char stormcellar_viewer_editor_js_begin[], stormcellar_viewer_editor_js_end[];
extern const char stormcellar_viewer_worker_js_begin[], stormcellar_viewer_worker_js_end[];
}

namespace stormcellar::web {

std::span<const ViewerFile> viewer_files() {
    static const std::array files{
        ViewerFile{"index.html",
                   "text/html; charset=utf-8",
                   {stormcellar_viewer_index_html_begin, stormcellar_viewer_index_html_end}},
        ViewerFile{"viewer.css",
                   "text/css; charset=utf-8",
                   {stormcellar_viewer_viewer_css_begin, stormcellar_viewer_viewer_css_end}},
        ViewerFile{"viewer.js",
                   "text/javascript; charset=utf-8",
                   {stormcellar_viewer_viewer_js_begin, stormcellar_viewer_viewer_js_end}},
        ViewerFile{"editor.js",
                   "text/javascript; charset=utf-8",
                   {stormcellar_viewer_editor_js_begin, stormcellar_viewer_editor_js_end}},
        ViewerFile{"worker.js",
                   "text/javascript; charset=utf-8",
                   {stormcellar_viewer_worker_js_begin, stormcellar_viewer_worker_js_end}},
    };
    return files;
}

}  // namespace stormcellar::web
