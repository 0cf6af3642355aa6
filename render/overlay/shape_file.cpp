#include "render/overlay/shape_file.h"

#include <string>

#include "base/printable.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::render {

Result<ShapeOverlay> read_shape_file(const std::filesystem::path& file) {
    constexpr std::uint64_t most_bytes = std::uint64_t{64} << 20U;
    const auto bytes = read_file(file, most_bytes);
    if (!bytes) return pass_on(bytes);
    std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const bool is_json = first != std::string_view::npos && text[first] == '{';
    auto shapes = is_json ? shapes_of_geojson(text) : shapes_of_placefile(text);
    if (!shapes)
        return fail(shapes.error().code, "{}: {}", printable(file.native()),
                    shapes.error().message);
    return shapes;
}

}  // namespace stormcellar::render
