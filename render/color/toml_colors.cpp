// Reads color tables in TOML.
#include <array>
#include <charconv>
#include <cmath>

#include "base/toml_file.h"
#include "render/color/built_in_tables.h"
#include "render/color/color_file.h"

namespace stormcellar::render {
namespace {

constexpr TomlRange values{-greatest_color_value, greatest_color_value};
constexpr TomlRange opacities_per_km{0, greatest_color_value};

// Parses "#rrggbb" or "#rrggbbaa".
std::optional<Rgba8> color_of_text(std::string_view text) {
    if ((text.size() != 7 && text.size() != 9) || text.front() != '#') return std::nullopt;
    Rgba8 color = {0, 0, 0, 255};
    for (std::size_t c = 0; 1 + 2 * c < text.size(); ++c) {
        const char* digits = text.data() + 1 + 2 * c;
        const auto [end, error] = std::from_chars(digits, digits + 2, color[c], 16);
        if (error != std::errc{} || end != digits + 2) return std::nullopt;
    }
    return color;
}

std::optional<Rgba8> color_of_numbers(const std::vector<double>& numbers) {
    if (numbers.size() != 3 && numbers.size() != 4) return std::nullopt;
    Rgba8 color = {0, 0, 0, 255};
    for (std::size_t c = 0; c < numbers.size(); ++c) {
        if (!std::isgreaterequal(numbers[c], 0.0) || !std::islessequal(numbers[c], 255.0)) {
            return std::nullopt;
        }
        color[c] = static_cast<std::uint8_t>(std::lround(numbers[c]));
    }
    return color;
}

std::optional<Rgba8> read_color(TomlTable& table, std::string_view key) {
    std::optional<Rgba8> color;
    if (table.is_array(key)) {
        const auto numbers = table.numbers(key);
        if (!numbers) return std::nullopt;
        color = color_of_numbers(*numbers);
    } else {
        const auto text = table.text(key);
        if (!text) return std::nullopt;
        color = color_of_text(*text);
    }
    if (!color) {
        table.complain(key, "must be \"#rrggbb\", \"#rrggbbaa\" or three or four numbers 0 to 255");
    }
    return color;
}

// Reads the moment and the unit. Returns true if the table is for a moment.
bool read_meaning(TomlTable& root, ColorTable& table) {
    table.name = root.text("name").value_or("");
    const auto unit = root.text("unit");
    const auto name = root.text("moment");
    if (unit) table.unit = *unit;
    if (!name) return false;
    const auto moment = level2::moment_from_name(*name);
    if (!moment) {
        root.complain("moment", "must be " + level2::moment_names(", ", " or "));
        return false;
    }
    table.moment = *moment;
    if (unit && *unit != unit_of(*moment)) {
        root.complain("unit", fmt::format("of {} must be \"{}\"", *name, unit_of(*moment)));
    }
    table.unit = unit_of(*moment);
    return true;
}

// Returns the newer spelling of the key, or the older spelling if only the older key is present. If
// both keys are present, the older key then counts as unknown.
std::string_view color_key_of(const TomlTable& point) {
    return point.has("colour") && !point.has("color") ? "colour" : "color";
}

void read_points(std::vector<TomlTable>& points, bool is_stepped, ColorTable& table) {
    std::size_t with_opacity = 0;
    bool blends_to_next = !is_stepped;
    for (TomlTable& point : points) {
        const std::string_view color_key = color_key_of(point);
        for (const std::string_view key : {std::string_view("value"), color_key}) {
            if (!point.has(key)) point.complain(key, "is missing");
        }
        const auto value = point.number("value", values);
        const Rgba8 color = read_color(point, color_key).value_or(Rgba8{});
        const auto until = read_color(point, "until");
        if (is_stepped && until) point.complain("until", "has no meaning where colors are stepped");
        const auto opacity = point.number("opacity_per_km", opacities_per_km);
        if (!value) continue;
        const auto from = static_cast<float>(*value);
        if (!table.stops.empty()) {
            ColorStop& before = table.stops.back();
            if (from <= before.from) point.complain("value", "must increase from point to point");
            if (blends_to_next) before.until = color;
        }
        table.stops.push_back({from, color, until.value_or(color)});
        blends_to_next = !is_stepped && !until;
        if (!opacity) continue;
        ++with_opacity;
        table.extinction.push_back({from, *opacity});
    }
    if (with_opacity != 0 && with_opacity != points.size()) {
        points.front().complain("opacity_per_km", "must be given for all points or for none");
    }
}

}  // namespace

Result<ColorTable> parse_toml_colors(std::string_view text, const std::string& name) {
    auto file = TomlFile::parse(text, name);
    if (!file) return pass_on(file);
    TomlTable root = file->root();
    ColorTable table;
    const bool of_moment = read_meaning(root, table);
    const bool is_stepped = root.flag("stepped").value_or(false);
    table.range_folded = read_color(root, "range_folded").value_or(usual_range_folded);
    const auto end = root.number("end", values);
    auto points = root.tables("point");
    const std::size_t least = is_stepped ? 1 : 2;
    if (points.size() < least || points.size() > most_stops) {
        root.complain("point", fmt::format("there must be {} to {} of them", least, most_stops));
    } else {
        read_points(points, is_stepped, table);
    }
    if (end && !table.stops.empty() && static_cast<float>(*end) <= table.stops.back().from) {
        root.complain("end", "must be above the last point's value");
    }
    if (auto fine = file->finish(); !fine) return pass_on(fine);

    const auto& stops = table.stops;
    const float length = stops.size() > 1 ? stops.back().from - stops.rbegin()[1].from : 1;
    table.end = end ? static_cast<float>(*end) : stops.back().from + length;
    if (table.extinction.empty()) table.extinction = extinction_of_colors(table, of_moment);
    if (auto valid = validate(table); !valid) {
        return fail(ErrorCode::bad_argument, "{}: the table {}", name, valid.error().message);
    }
    return table;
}

}  // namespace stormcellar::render
