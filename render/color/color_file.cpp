#include "render/color/color_file.h"

#include <algorithm>
#include <cctype>
#include <cstring>

#include "render/color/built_in_tables.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::render {
namespace {

std::string lower_ending(const std::filesystem::path& file) {
    std::string ending = file.extension().native();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

}  // namespace

Result<ColorTable> read_color_file(const std::filesystem::path& file) {
    const std::string ending = lower_ending(file);
    if (ending != ".pal" && ending != ".toml") {
        return fail(ErrorCode::bad_argument,
                    "{}: the file of a color table must end in .pal or .toml", file.native());
    }
    const auto bytes = read_file(file, most_color_file_bytes);
    if (!bytes) return pass_on(bytes);
    std::string text(bytes->size(), '\0');
    if (!text.empty()) std::memcpy(text.data(), bytes->data(), text.size());
    auto table =
        ending == ".pal" ? parse_pal(text, file.native()) : parse_toml_colors(text, file.native());
    if (table && table->name.empty()) table->name = file.stem().native();
    return table;
}

Result<ColorTable> colors_from(const std::string& name_or_file) {
    const std::string ending = lower_ending(name_or_file);
    if (ending == ".pal" || ending == ".toml") return read_color_file(name_or_file);
    auto table = find_color_table(name_or_file);
    if (table) return table;
    const std::string& why = table.error().message;
    return fail(ErrorCode::bad_argument, "{}{}", why,
                why.ends_with('?') ? "" : "; or name a .pal or .toml file");
}

std::vector<ExtinctionPoint> extinction_of_colors(const ColorTable& table, bool of_moment) {
    std::vector<ExtinctionPoint> points;
    if (of_moment) {
        points = default_extinction(table.moment, table.lowest());
    } else {
        points = {{table.lowest(), 0.02}, {table.end, 0.5}};
    }
    for (ExtinctionPoint& point : points) {
        const auto color = color_of(table, std::max(point.value, table.lowest()));
        point.per_km *= (*color)[3] / 255.0;
    }
    return points;
}

}  // namespace stormcellar::render
