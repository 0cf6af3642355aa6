#include "web/doors/wms/request.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/number_list.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "render/color/built_in_tables.h"
#include "web/doors/thredds/w3c_times.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t longest_shown_text = 80;
constexpr std::string_view default_style = "default";

std::string shown(std::string_view text) {
    return printable(text.substr(0, longest_shown_text));
}

bool same_letters(std::string_view a, std::string_view b) {
    return std::ranges::equal(a, b, [](char left, char right) {
        const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; };
        return lower(left) == lower(right);
    });
}

std::vector<std::string_view> parts_of(std::string_view list) {
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t comma = list.find(',');
        parts.push_back(list.substr(0, comma));
        if (comma == std::string_view::npos) return parts;
        list.remove_prefix(comma + 1);
    }
}

WmsRead<int> whole_number(const WmsParameters& parameters, std::string_view name, int least,
                          int most) {
    const auto text = parameters.find(name);
    if (!text) return wms_fault("", fmt::format("{} is missing.", name));
    const auto number = parse_number<int>(*text);
    if (!number || *number < least || *number > most)
        return wms_fault("", fmt::format("{} is a whole number from {} to {}, not '{}'.", name,
                                         least, most, shown(*text)));
    return *number;
}

// Reads a color such as "0xFFFFFF", which is the standard's form.
WmsRead<render::Rgba8> color_of_text(std::string_view text) {
    std::uint32_t number = 0;
    const bool has_prefix = text.starts_with("0x") || text.starts_with("0X");
    const std::string_view digits = has_prefix ? text.substr(2) : text;
    const auto [rest, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
    if (!has_prefix || digits.size() != 6 || error != std::errc{} ||
        rest != digits.data() + digits.size())
        return wms_fault(
            "", fmt::format("BGCOLOR is six hexadecimal digits after 0x, not '{}'.", shown(text)));
    const auto byte = [number](int shift) { return static_cast<std::uint8_t>(number >> shift); };
    return render::Rgba8{byte(16), byte(8), byte(0), 255};
}

// Reads the background. For JPEG, which has no transparency, TRANSPARENT has no effect, as the
// standard says.
WmsRead<std::optional<render::Rgba8>> ground_of(const WmsParameters& parameters, bool is_jpeg) {
    const auto transparent = parameters.find("TRANSPARENT");
    const bool is_true = transparent && same_letters(*transparent, "true");
    if (is_true && !is_jpeg) return std::nullopt;
    if (transparent && !is_true && !same_letters(*transparent, "false"))
        return wms_fault(
            "", fmt::format("TRANSPARENT is TRUE or FALSE, not '{}'.", shown(*transparent)));
    const auto color = color_of_text(parameters.find("BGCOLOR").value_or("0xFFFFFF"));
    if (!color) return tl::unexpected(color.error());
    return *color;
}

struct System {
    render::Plane plane = render::Plane::web_mercator;
    bool latitude_first = false;
};
WmsRead<System> system_of(const WmsParameters& parameters, WmsVersion version) {
    const std::string_view name = version == WmsVersion::v1_3_0 ? "CRS" : "SRS";
    const auto text = parameters.find(name);
    if (!text) return wms_fault("", fmt::format("{} is missing.", name));
    if (*text == wms_systems[0] || *text == older_web_mercator) return System{};
    if (*text == wms_systems[1])
        return System{render::Plane::degrees, version == WmsVersion::v1_3_0};
    if (*text == wms_systems[2]) return System{render::Plane::degrees, false};
    return wms_fault(version == WmsVersion::v1_3_0 ? "InvalidCRS" : "InvalidSRS",
                     fmt::format("There is no system '{}' here: there are {}.", shown(*text),
                                 fmt::join(wms_systems, ", ")));
}

WmsRead<render::PlaneWindow> window_of_map(const WmsParameters& parameters, WmsVersion version) {
    const auto system = system_of(parameters, version);
    if (!system) return tl::unexpected(system.error());
    const auto text = parameters.find("BBOX");
    if (!text) return wms_fault("", "BBOX is missing.");
    const auto ends = parse_numbers(*text, ',');
    if (!ends || ends->size() != 4)
        return wms_fault("", fmt::format("BBOX is four numbers, not '{}'.", shown(*text)));
    const std::vector<double>& box = *ends;
    if (box[0] >= box[2] || box[1] >= box[3])
        return wms_fault("", "The first two numbers of BBOX must be below the other two.");
    const double most =
        system->plane == render::Plane::degrees ? 1080 : 6 * render::mercator_edge_m;
    if (std::ranges::any_of(box, [most](double end) { return std::abs(end) > most; }))
        return wms_fault("", "BBOX lies far beyond the earth.");
    const auto width = whole_number(parameters, "WIDTH", 1, most_wms_side);
    if (!width) return tl::unexpected(width.error());
    const auto height = whole_number(parameters, "HEIGHT", 1, most_wms_side);
    if (!height) return tl::unexpected(height.error());
    if (system->latitude_first)
        return render::PlaneWindow{system->plane, box[1], box[0], box[3], box[2], *width, *height};
    return render::PlaneWindow{system->plane, box[0], box[1], box[2], box[3], *width, *height};
}

// Returns the options that this layer uses, with its style as the option `colors`.
Fields options_of_layer(const WmsParameters& parameters, const MapProduct& layer,
                        std::string_view style) {
    Fields options;
    const bool has_style = !style.empty() && style != default_style;
    if (has_style) options.emplace_back("colors", style);
    for (const render::PictureOption& row : render::picture_options()) {
        if (!is_of_layers(row) || !row.is_used_by(layer.product)) continue;
        if (has_style && &row == &render::colors_option()) continue;
        const std::string_view name = render::parameter_of(row);
        if (const auto text = parameters.find(name)) options.emplace_back(name, *text);
    }
    return options;
}

WmsRead<WmsLayer> layer_named(const WmsParameters& parameters, std::string_view name,
                              std::string_view style) {
    const std::size_t colon = name.rfind(':');
    if (colon == std::string_view::npos || colon == 0)
        return wms_fault(
            "LayerNotDefined",
            fmt::format("A layer is named as in KTLX:composite.REF, not '{}'.", shown(name)), 404);
    const auto layer = map_product_named(name.substr(colon + 1));
    if (!layer) return wms_fault("LayerNotDefined", layer.error().message + ".", 404);
    auto read = map_style(*layer, options_of_layer(parameters, *layer, style), {});
    if (!read) return wms_fault(style.empty() ? "" : "StyleNotDefined", read.error().message + ".");
    return WmsLayer{std::string(name.substr(0, colon)), std::move(*read)};
}

WmsRead<std::optional<UtcTime>> time_of(const WmsParameters& parameters, UtcTime now) {
    const auto text = parameters.find("TIME");
    if (!text || same_letters(*text, "current") || same_letters(*text, "default"))
        return std::nullopt;
    if (text->find_first_of("/,") != std::string_view::npos)
        return wms_fault("InvalidDimensionValue", "TIME is one instant, not a list or a period.");
    const auto time = parse_w3c_time(*text, now);
    if (!time) return wms_fault("InvalidDimensionValue", "TIME: " + time.error().message + ".");
    return *time;
}

}  // namespace

std::optional<std::string_view> WmsParameters::find(std::string_view name) const {
    for (const auto& [key, text] : query_) {
        if (!same_letters(key, name)) continue;
        if (text.empty()) return std::nullopt;
        return text;
    }
    return std::nullopt;
}

WmsRead<WmsVersion> wms_version(const WmsParameters& parameters) {
    const std::string_view version = parameters.find("VERSION").value_or("1.3.0");
    if (version == "1.3.0") return WmsVersion::v1_3_0;
    if (version == "1.1.1") return WmsVersion::v1_1_1;
    return wms_fault(
        "", fmt::format("There are versions 1.3.0 and 1.1.1 here, not '{}'.", shown(version)));
}

WmsVersion wms_nearest_version(const WmsParameters& parameters) {
    const std::string_view version = parameters.find("VERSION").value_or("1.3.0");
    return version < "1.3.0" ? WmsVersion::v1_1_1 : WmsVersion::v1_3_0;
}

std::string wms_layer_name(std::string_view domain, const MapProduct& layer) {
    return fmt::format("{}:{}", domain, layer.name());
}

std::vector<std::string> wms_styles_of(const MapProduct& layer) {
    std::vector<std::string> names{std::string(default_style)};
    render::Scene scene;
    scene.product = layer.product;
    scene.moment = layer.moment;
    if (render::facts_of(layer.product).colors == nullptr)
        names.insert(names.end(), render::color_families.begin(), render::color_families.end());
    const std::string unit = render::unit_shown(scene);
    for (const render::ColorTable& table : render::built_in_tables())
        if (table.moment == render::table_moment(layer.moment) && table.unit == unit)
            names.push_back(table.name);
    return names;
}

WmsRead<std::vector<WmsLayer>> wms_layers(const WmsParameters& parameters, std::string_view layers,
                                          std::string_view styles) {
    const auto names = parts_of(layers);
    if (names.size() > most_wms_layers)
        return wms_fault("", fmt::format("A picture has at most {} layers.", most_wms_layers));
    const auto style_names = parts_of(styles);
    if (!styles.empty() && style_names.size() != names.size())
        return wms_fault("StyleNotDefined", "STYLES must name as many styles as there are layers.");
    std::vector<WmsLayer> read;
    for (std::size_t i = 0; i < names.size(); ++i) {
        auto layer = layer_named(parameters, names[i], styles.empty() ? "" : style_names[i]);
        if (!layer) return tl::unexpected(layer.error());
        read.push_back(std::move(*layer));
    }
    return read;
}

WmsRead<WmsMap> wms_map(const WmsParameters& parameters, UtcTime now) {
    const auto version = wms_version(parameters);
    if (!version) return tl::unexpected(version.error());
    const auto names = parameters.find("LAYERS");
    if (!names) return wms_fault("LayerNotDefined", "LAYERS is missing.");
    const std::string_view format = parameters.find("FORMAT").value_or("image/png");
    const bool is_jpeg = format == "image/jpeg";
    if (!is_jpeg && format != "image/png" && format != "image/png; mode=8bit")
        return wms_fault(
            "InvalidFormat",
            fmt::format("FORMAT is image/png or image/jpeg, not '{}'.", shown(format)));
    auto layers = wms_layers(parameters, *names, parameters.find("STYLES").value_or(""));
    if (!layers) return tl::unexpected(layers.error());
    auto window = window_of_map(parameters, *version);
    if (!window) return tl::unexpected(window.error());
    auto ground = ground_of(parameters, is_jpeg);
    if (!ground) return tl::unexpected(ground.error());
    auto time = time_of(parameters, now);
    if (!time) return tl::unexpected(time.error());
    return WmsMap{std::move(*layers), *window, *ground, *time, is_jpeg};
}

WmsRead<WmsPixel> wms_pixel(const WmsParameters& parameters, const render::PlaneWindow& window) {
    const bool is_older = !parameters.find("I") && parameters.find("X");
    const auto column = whole_number(parameters, is_older ? "X" : "I", 0, window.width - 1);
    const auto row = whole_number(parameters, is_older ? "Y" : "J", 0, window.height - 1);
    for (const auto* number : {&column, &row})
        if (!*number) return wms_fault("InvalidPoint", number->error().text);
    return WmsPixel{*column, *row};
}

grid::GeoPoint place_of(const WmsPixel& pixel, const render::PlaneWindow& window) {
    const double x =
        window.west + (pixel.column + 0.5) * (window.east - window.west) / window.width;
    const double y =
        window.north - (pixel.row + 0.5) * (window.north - window.south) / window.height;
    double longitude = x;
    double latitude = y;
    if (window.plane == render::Plane::web_mercator) {
        longitude = x / render::mercator_radius_m * 180 / std::numbers::pi;
        latitude = render::mercator_latitude_deg(y);
    }
    return {std::clamp(latitude, -90.0, 90.0), std::remainder(longitude, 360.0)};
}

}  // namespace stormcellar::web
