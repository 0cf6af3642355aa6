// web/doors/index/index_files.h -- the files of the index page, linked into the program.
#pragma once

#include <string_view>

namespace stormcellar::web {

[[nodiscard]] std::string_view index_page();
[[nodiscard]] std::string_view index_style();
[[nodiscard]] std::string_view index_script();

}  // namespace stormcellar::web
