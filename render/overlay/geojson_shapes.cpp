#include <array>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "render/overlay/event_colors.h"
#include "render/overlay/shape_file.h"
#include "render/overlay/shape_values.h"

namespace stormcellar::render {
namespace {

using Json = nlohmann::json;

constexpr std::array begin_names = {"polygon_begin", "onset", "issue", "effective", "begin"};
constexpr std::array end_names = {"polygon_end", "ends", "expire", "expires", "end"};

// Returns the first of these properties that is a text; empty if there is none.
template <class Names>
std::string text_of(const Json& properties, const Names& names) {
    for (const char* name : names) {
        const auto found = properties.find(name);
        if (found == properties.end() || !found->is_string()) continue;
        const auto& text = found->template get_ref<const std::string&>();
        if (!text.empty()) return text;
    }
    return {};
}

// Returns the time of the first of these properties that is present. The last name is a common
// word, so if its property is not a time, returns none.
template <class Names>
Result<std::optional<UtcTime>> time_of(const Json& properties, const Names& names) {
    const std::string text = text_of(properties, names);
    if (text.empty()) return std::nullopt;
    const auto time = shape_time(text);
    if (!time && text == text_of(properties, std::array{names.back()})) return std::nullopt;
    if (!time) return pass_on(time);
    return *time;
}

Result<std::optional<Rgba8>> color_of(const Json& properties) {
    const std::string given = text_of(properties, std::array{"stroke", "marker-color", "color"});
    if (given.starts_with('#')) {
        const auto color = shape_color(given);
        if (!color) return pass_on(color);
        return *color;
    }
    const std::string event = text_of(properties, std::array{"event"});
    for (const EventColor& known : event_colors)
        if (known.event == event) return known.color;
    return std::nullopt;
}

// Returns what all shapes of a feature share.
Result<OverlayShape> style_of(const Json& feature) {
    OverlayShape style;
    const auto found = feature.find("properties");
    if (found == feature.end() || !found->is_object()) return style;
    const Json& properties = *found;
    const auto color = color_of(properties);
    if (!color) return pass_on(color);
    const auto from = time_of(properties, begin_names);
    if (!from) return pass_on(from);
    const auto until = time_of(properties, end_names);
    if (!until) return pass_on(until);
    style.color = *color;
    style.from = *from;
    style.until = *until;
    style.label = shape_label(text_of(properties, std::array{"title", "name"}));
    if (const auto width = properties.find("stroke-width");
        width != properties.end() && width->is_number())
        style.width = std::clamp(width->get<float>(), 0.5F, 20.0F);
    return style;
}

// A kind of geometry. Its points or lines are nested in `lists` lists.
struct Kind {
    std::string_view type;
    int lists;
    bool is_of_points;
};
constexpr std::array<Kind, 6> kinds = {{{"Point", 0, true},
                                        {"MultiPoint", 1, true},
                                        {"LineString", 0, false},
                                        {"MultiLineString", 1, false},
                                        {"Polygon", 1, false},
                                        {"MultiPolygon", 2, false}}};

class GeoJsonReader {
  public:
    Status read(const Json& value) {
        if (!value.is_object()) return fail(ErrorCode::corrupt, "it is no object of GeoJSON");
        const std::string type = type_of(value);
        if (type != "FeatureCollection") return read_feature(value);
        const auto features = value.find("features");
        if (features == value.end() || !features->is_array())
            return fail(ErrorCode::corrupt, "its FeatureCollection has no features");
        std::size_t number = 0;
        for (const Json& feature : *features) {
            const Status read = read_feature(feature);
            if (!read)
                return fail(read.error().code, "feature {}: {}", number, read.error().message);
            ++number;
        }
        return {};
    }
    ShapeOverlay taken;

  private:
    static std::string type_of(const Json& value) {
        return value.is_object() ? text_of(value, std::array{"type"}) : std::string{};
    }

    Status read_feature(const Json& feature) {
        if (type_of(feature) != "Feature") return read_geometry(feature, {});
        const auto style = style_of(feature);
        if (!style) return pass_on(style);
        const auto geometry = feature.find("geometry");
        if (geometry == feature.end() || geometry->is_null()) {
            ++taken.unknown;
            return {};
        }
        return read_geometry(*geometry, *style);
    }

    Status read_geometry(const Json& geometry, const OverlayShape& style) {
        const std::string type = type_of(geometry);
        if (type == "GeometryCollection") {
            const auto parts = geometry.find("geometries");
            if (parts == geometry.end()) return fail(ErrorCode::corrupt, "it has no geometries");
            for (const Json& part : *parts) {
                if (type_of(part) == "GeometryCollection")
                    return fail(ErrorCode::corrupt, "a GeometryCollection is in another one");
                if (Status read = read_geometry(part, style); !read) return read;
            }
            return {};
        }
        const auto kind = std::ranges::find(kinds, type, &Kind::type);
        if (kind == kinds.end())
            return fail(ErrorCode::corrupt, "'{}' is no geometry of GeoJSON", printable(type));
        const auto places = geometry.find("coordinates");
        if (places == geometry.end()) return fail(ErrorCode::corrupt, "it has no coordinates");
        return read_places(*places, kind->lists, kind->is_of_points, style);
    }

    // Reads points or lines that are nested in this many lists.
    Status read_places(const Json& places, int lists, bool is_of_points,
                       const OverlayShape& style) {
        if (!places.is_array()) return fail(ErrorCode::corrupt, "its coordinates are no list");
        if (lists == 0) return is_of_points ? add_point(places, style) : add_line(places, style);
        for (const Json& part : places)
            if (Status read = read_places(part, lists - 1, is_of_points, style); !read) return read;
        return {};
    }

    Status add_point(const Json& place, const OverlayShape& style) {
        if (place.empty()) return {};  // RFC 7946: an empty geometry is a missing geometry
        OverlayShape point = style;
        if (Status added = take_place(point, place); !added) return added;
        taken.shapes.push_back(std::move(point));
        return {};
    }

    Status add_line(const Json& places, const OverlayShape& style) {
        OverlayShape line = style;
        line.label.clear();  // only points have one
        for (const Json& place : places)
            if (Status added = take_place(line, place); !added) return added;
        if (line.points.size() > 1) taken.shapes.push_back(std::move(line));
        return {};
    }

    Status take_place(OverlayShape& shape, const Json& place) {
        const bool has_both =
            place.is_array() && place.size() >= 2 && place[0].is_number() && place[1].is_number();
        if (!has_both) return fail(ErrorCode::corrupt, "a position is no list of two numbers");
        const auto at = shape_place(place[1].get<double>(), place[0].get<double>());
        if (!at) return pass_on(at);
        if (++points_ > most_shape_points)
            return fail(ErrorCode::over_budget, "it has more than {} points", most_shape_points);
        shape.points.push_back(*at);
        return {};
    }

    std::size_t points_ = 0;
};

}  // namespace

Result<ShapeOverlay> shapes_of_geojson(std::string_view text) {
    const Json value = Json::parse(text, nullptr, false);
    if (value.is_discarded()) return fail(ErrorCode::corrupt, "it is no valid JSON");
    GeoJsonReader reader;
    if (Status read = reader.read(value); !read) return pass_on(read);
    return std::move(reader.taken);
}

}  // namespace stormcellar::render
