#include "web/doors/overlays/served_overlays.h"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/checksum.h"
#include "base/printable.h"
#include "render/overlay/shape_file.h"
#include "web/data/grids/text_answer.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Returns the files of an overlay. A missing file and a directory that cannot be listed are also
// returned, so that the answer tells clients about them.
std::vector<fs::path> files_of(const ConfiguredOverlay& overlay) {
    std::error_code problem;
    if (!fs::is_directory(overlay.path, problem)) return {overlay.path};
    std::vector<fs::path> files;
    for (fs::directory_iterator entry(overlay.path, problem), end; !problem && entry != end;
         entry.increment(problem)) {
        std::error_code unknown;
        const bool is_hidden = entry->path().filename().native().starts_with('.');
        if (!is_hidden && entry->is_regular_file(unknown)) files.push_back(entry->path());
    }
    std::ranges::sort(files);
    if (problem) files.push_back(overlay.path);
    return files;
}

std::string stamp_of(const std::vector<fs::path>& files) {
    std::string stamp;
    for (const fs::path& file : files) {
        std::error_code problem;
        const auto size = fs::file_size(file, problem);
        const auto time = fs::last_write_time(file, problem).time_since_epoch().count();
        stamp += fmt::format("{}\n{} {} {}\n", file.native(), size, time, problem.value());
    }
    return stamp;
}

ordered_json place_of(grid::GeoPoint place) {
    return {place.longitude_deg, place.latitude_deg};
}

ordered_json feature_of(const render::OverlayShape& shape) {
    ordered_json properties = ordered_json::object();
    if (shape.color) {
        const auto& color = *shape.color;
        properties["stroke"] = fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
    }
    properties["stroke-width"] = shape.width;
    if (!shape.label.empty()) properties["name"] = shape.label;
    if (shape.from) properties["begin"] = format_utc(*shape.from);
    if (shape.until) properties["end"] = format_utc(*shape.until);
    const bool is_point = shape.points.size() == 1;
    ordered_json places = ordered_json::array();
    if (is_point) {
        places = place_of(shape.points.front());
    } else {
        for (const grid::GeoPoint& place : shape.points)
            places.push_back(place_of(place));
    }
    return {{"type", "Feature"},
            {"properties", std::move(properties)},
            {"geometry",
             {{"type", is_point ? "Point" : "LineString"}, {"coordinates", std::move(places)}}}};
}

constexpr std::size_t index_of(Coding coding) {
    return static_cast<std::size_t>(coding);
}

std::size_t points_of(const render::ShapeOverlay& shapes) {
    std::size_t points = 0;
    for (const render::OverlayShape& shape : shapes.shapes)
        points += shape.points.size();
    return points;
}

std::string made_of(const std::vector<fs::path>& files) {
    ordered_json features = ordered_json::array(), left_out = ordered_json::array();
    std::size_t points = 0;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto leave_out = [&](std::string_view why) {
            left_out.push_back(fmt::format("{}: {}", printable(files[i].filename().native()), why));
        };
        if (i >= ServedOverlays::most_files) {
            leave_out("too many files");
            continue;
        }
        const auto shapes = render::read_shape_file(files[i]);
        if (!shapes) {
            leave_out(without_paths(shapes.error().message));
            continue;
        }
        if (points + points_of(*shapes) > ServedOverlays::most_points) {
            leave_out("too many points");
            continue;
        }
        points += points_of(*shapes);
        for (const render::OverlayShape& shape : shapes->shapes)
            features.push_back(feature_of(shape));
    }
    ordered_json collection = {{"type", "FeatureCollection"}, {"features", std::move(features)}};
    if (!left_out.empty()) collection["left_out"] = std::move(left_out);
    return collection.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

ServedOverlays::ServedOverlays(const std::vector<ConfiguredOverlay>& overlays) {
    for (const ConfiguredOverlay& overlay : overlays)
        overlays_.push_back(std::make_unique<Overlay>(overlay));
}

std::vector<std::string> ServedOverlays::names() const {
    std::vector<std::string> names;
    for (const auto& overlay : overlays_)
        names.push_back(overlay->configured.name);
    return names;
}

std::optional<Result<SentOverlay>> ServedOverlays::geojson(std::string_view name,
                                                           Coding coding) const {
    const auto found = std::ranges::find_if(
        overlays_, [name](const auto& overlay) { return overlay->configured.name == name; });
    if (found == overlays_.end()) return std::nullopt;
    Overlay& overlay = **found;
    const auto files = files_of(overlay.configured);
    std::string stamp = stamp_of(files);
    const MutexLock lock(overlay.mutex);
    const Text& whole = overlay.texts[index_of(Coding::identity)];
    if (whole == nullptr || overlay.stamp != stamp) {
        overlay.texts = {text_of(made_of(files))};
        overlay.hash = fmt::format("{:016x}", xxh3_64(std::as_bytes(std::span(*whole))));
        overlay.stamp = std::move(stamp);
    }
    if (whole->size() < least_compressed_text) coding = Coding::identity;
    Text& sent = overlay.texts[index_of(coding)];
    if (sent == nullptr) {
        auto bytes = compressed(*whole, coding);
        if (!bytes) return pass_on(bytes);
        sent = text_of(std::move(*bytes));
    }
    const bool is_whole = coding == Coding::identity;
    return SentOverlay{
        sent, fmt::format("\"{}{}{}\"", overlay.hash, is_whole ? "" : "-", coding_name(coding)),
        coding};
}

}  // namespace stormcellar::web
