#include "web/doors/index/index_files.h"

#include "web/doors/embedded_file.h"

STORMCELLAR_EMBED(index_page, STORMCELLAR_INDEX_PAGE "/index.html");
STORMCELLAR_EMBED(index_style, STORMCELLAR_INDEX_PAGE "/index.css");
STORMCELLAR_EMBED(index_script, STORMCELLAR_INDEX_PAGE "/index.mjs");

namespace stormcellar::web {

std::string_view index_page() {
    return STORMCELLAR_EMBEDDED(index_page);
}

std::string_view index_style() {
    return STORMCELLAR_EMBEDDED(index_style);
}

std::string_view index_script() {
    return STORMCELLAR_EMBEDDED(index_script);
}

}  // namespace stormcellar::web
