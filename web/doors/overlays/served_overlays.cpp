#include "web/doors/overlays/served_overlays.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "render/overlay/shape_file.h"

namespace stormcellar::web {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Returns the files of an overlay. A file that is not there is one of them, so that a client learns
// that it is missing.
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

std::string made_of(const std::vector<fs::path>& files) {
    ordered_json features = ordered_json::array(), left_out = ordered_json::array();
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string name = printable(files[i].filename().native());
        if (i >= ServedOverlays::most_files) {
            left_out.push_back(
                fmt::format("{}: is beyond the first {} files", name, ServedOverlays::most_files));
            continue;
        }
        const auto shapes = render::read_shape_file(files[i]);
        if (!shapes) {
            left_out.push_back(fmt::format("{}: {}", name, without_paths(shapes.error().message)));
            continue;
        }
        for (const render::OverlayShape& shape : shapes->shapes)
            features.push_back(feature_of(shape));
    }
    ordered_json collection = {{"type", "FeatureCollection"}, {"features", std::move(features)}};
    if (!left_out.empty()) collection["left_out"] = std::move(left_out);
    return collection.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::optional<Text> ServedOverlays::geojson(std::string_view name) const {
    const auto overlay = std::ranges::find(overlays_, name, &ConfiguredOverlay::name);
    if (overlay == overlays_.end()) return std::nullopt;
    const auto files = files_of(*overlay);
    std::string stamp = stamp_of(files);
    const MutexLock lock(mutex_);
    const auto known = made_.find(name);
    if (known != made_.end() && known->second.stamp == stamp) return known->second.text;
    const Text text = text_of(made_of(files));
    made_.insert_or_assign(std::string(name), Made{std::move(stamp), text});
    return text;
}

}  // namespace stormcellar::web
