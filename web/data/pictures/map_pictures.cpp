#include "web/data/pictures/map_pictures.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/checksum.h"
#include "base/printable.h"
#include "render/options/scene_options.h"
#include "render/products/smooth_field.h"
#include "render/still/legend_panel.h"
#include "stormcellar/base/version.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/render/png_file.h"
#include "stormcellar/render/still.h"

namespace stormcellar::web {
namespace {

// Raise this number whenever the same grid gives another picture than before.
constexpr int version_of_pictures = 1;
constexpr int longest_reach_km = 500;  // of any sweep
constexpr double tolerated_octaves = 0.2;
constexpr std::size_t most_boxes_known = 512;
constexpr std::size_t longest_shown_domain = 80;

std::string text_of_bytes(const std::vector<std::byte>& bytes) {
    std::string text(bytes.size(), '\0');
    if (!bytes.empty()) std::memcpy(text.data(), bytes.data(), bytes.size());
    return text;
}

// Draws the image `upper` over `lower`. Both may be partly transparent.
void lay_over(const render::Image& upper, render::Image& lower) {
    for (std::size_t i = 0; i < lower.rgba.size(); i += 4) {
        const int alpha = upper.rgba[i + 3];
        if (alpha == 0) continue;
        const int below = lower.rgba[i + 3] * (255 - alpha) / 255;
        const int sum = alpha + below;
        for (std::size_t c = 0; c < 3; ++c) {
            const int mixed = upper.rgba[i + c] * alpha + lower.rgba[i + c] * below;
            lower.rgba[i + c] = static_cast<std::uint8_t>((mixed + sum / 2) / sum);
        }
        lower.rgba[i + 3] = static_cast<std::uint8_t>(sum);
    }
}

double pixel_height_m(const render::PlaneWindow& window, const grid::GridSpec& spec) {
    const double pixel = (window.north - window.south) / window.height;
    const grid::DegreeLength degree = grid::degree_length(spec.center_latitude_deg);
    if (window.plane == render::Plane::degrees) return pixel * degree.north_m;
    return pixel * std::cos(spec.center_latitude_deg * std::numbers::pi / 180);
}

}  // namespace

std::string MapPicture::key() const {
    std::string key =
        fmt::format("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {}x{}", version_of_pictures,
                    static_cast<int>(window.plane), window.west, window.south, window.east,
                    window.north, window.width, window.height);
    if (ground) key += fmt::format(" {:02x}", fmt::join(*ground, ""));
    if (ending != ".png") key += fmt::format(" {}", ending);
    for (const PictureLayer& layer : layers)
        key += fmt::format("\n{}/{}", layer.sweep ? layer.sweep->key() : layer.grid->id,
                           layer.style.key);
    return key;
}

std::string MapPicture::etag() const {
    const std::string all = fmt::format("{} {}", software_version, key());
    return fmt::format("\"{:016x}\"", xxh3_64(std::as_bytes(std::span(all))));
}

MapPictures::MapPictures(MapPicturesOptions options)
    : options_(std::move(options)),
      maps_(options_.map_bytes, options_.grids->cache()),
      boxes_({.values = most_boxes_known}) {
    if (!options_.rain)
        options_.rain = std::make_shared<RainTotals>(RainTotalsOptions{.grids = options_.grids});
}

std::vector<MapProduct> MapPictures::layers_of(std::string_view domain) const {
    const Grids& grids = *options_.grids;
    auto layers = map_products_of(grids.moments(domain));
    if (grids.times(domain, RainTotals::listed_moment(grids, domain)).size() < 2)
        std::erase_if(layers, [](const MapProduct& layer) { return layer.hours > 0; });
    return layers;
}

level2::Moment MapPictures::listed_moment(std::string_view domain, const MapProduct& layer) const {
    return layer.hours > 0 ? RainTotals::listed_moment(*options_.grids, domain) : layer.moment;
}

Result<std::shared_ptr<const OpenGrid>> MapPictures::find_grid(std::string_view domain,
                                                               const MapProduct& layer,
                                                               UtcTime time) {
    if (layer.hours > 0) return options_.rain->find(std::string(domain), layer.hours, time);
    return options_.grids->find(domain, layer.moment, time);
}

std::shared_ptr<const OpenGrid> MapPictures::find_grid_if_open(std::string_view domain,
                                                               const MapProduct& layer,
                                                               UtcTime time) {
    if (layer.hours > 0) return options_.rain->find_if_kept(std::string(domain), layer.hours, time);
    return options_.grids->find_if_open(domain, layer.moment, time);
}

std::optional<Kept> MapPictures::find(const MapPicture& picture) {
    return options_.kept->find(picture.key());
}

Result<Kept> MapPictures::find_or_draw(const MapPicture& picture) {
    return options_.kept->find_or_make(picture.key(), [&] { return draw(picture); });
}

Result<Kept> MapPictures::draw(const MapPicture& picture) {
    const render::PlaneWindow& window = picture.window;
    render::Image image(window.width, window.height, picture.ground.value_or(render::Rgba8{}));
    for (std::size_t i = 0; i < picture.layers.size(); ++i) {
        auto layer = drawn(picture.layers[i], window);
        if (!layer) return pass_on(layer);
        if (i == 0 && !picture.ground) {
            image = std::move(*layer);
        } else {
            lay_over(*layer, image);
        }
    }
    const render::StillFormat& format = *render::still_format_of(picture.ending);
    const auto bytes = picture.ending == ".png" ? render::encode_png_of_few_colors(image)
                                                : format.encode_picture(image, {});
    if (!bytes) return pass_on(bytes);
    return Kept{text_of(text_of_bytes(*bytes)), picture.etag(), std::string(format.media_type)};
}

Result<render::Image> MapPictures::drawn(const PictureLayer& layer,
                                         const render::PlaneWindow& window) {
    const OpenGrid& grid = *layer.grid;
    const render::Scene& scene = layer.style.scene;
    std::shared_ptr<const FlatMap> sweep;
    if (layer.sweep) {
        // Decode no volume for tiles far from the radar.
        const grid::SitePosition& site = grid.file.description().sites.front();
        grid::GridSpec reach = grid::default_spec(site.latitude_deg, site.longitude_deg);
        reach.nx = reach.ny = 2 * longest_reach_km;
        if (!render::meets(window, box_of(grid.domain, reach)))
            return render::Image(window.width, window.height,
                                 render::color_outside(layer.style.look));
        auto made = maps_.find_or_make(*layer.sweep, *options_.sweeps, options_.threads);
        if (!made) return pass_on(made);
        sweep = std::move(*made);
    }
    const grid::GridSpec& spec = sweep ? sweep->spec : grid.file.description().spec;
    const render::EarthBox box = box_of(grid.domain, spec);
    if (!render::meets(window, box))
        return render::Image(window.width, window.height, render::color_outside(layer.style.look));
    const auto map = sweep ? Result<std::shared_ptr<const FlatMap>>(sweep)
                           : maps_.find_or_make(grid, scene, options_.threads);
    if (!map) return pass_on(map);
    const int halvings = halvings_for(window, spec, (*map)->levels.size());
    return render::draw_on_plane({.spec = spec,
                                  .box = box,
                                  .field = (*map)->levels[static_cast<std::size_t>(halvings)],
                                  .halvings = halvings,
                                  .table = render::colors_of(scene),
                                  .smooth = !sweep && render::is_smoothed(scene),
                                  .look = layer.style.look,
                                  .sweep = sweep ? &sweep->sweep->sweep : nullptr},
                                 window);
}

Result<grid::GridSpec> MapPictures::plane_of(const SweepPicture& sweep) {
    const auto map = maps_.find_or_make(sweep, *options_.sweeps, options_.threads);
    if (!map) return pass_on(map);
    return (*map)->spec;
}

Result<std::optional<MapValue>> MapPictures::value_at(const PictureLayer& layer,
                                                      const grid::GeoPoint& place) {
    const grid::GridSpec& spec = layer.grid->file.description().spec;
    const grid::ColumnPoint at = grid::GridProjection(spec).to_column(place);
    const double x = std::floor(at.x + 0.5);
    const double y = std::floor(at.y + 0.5);
    // If the projection has no column for the place, x and y are NaN, so this comparison is false.
    if (!(x >= 0 && y >= 0 && x < spec.nx && y < spec.ny)) return std::nullopt;
    const auto map = maps_.find_or_make(*layer.grid, layer.style.scene, options_.threads);
    if (!map) return pass_on(map);
    const render::FlatField& field = (*map)->levels.front();
    const std::size_t index = field.index(static_cast<int>(x), static_cast<int>(y));
    return MapValue{field.status[index], field.values[index]};
}

Result<Kept> MapPictures::legend(const PictureLayer& layer) {
    const OpenGrid& grid = *layer.grid;
    const render::FrameFacts facts =
        render::frame_facts_of(grid.domain, grid.file.description(), "UTC");
    const auto panel = render::draw_legend_panel({grid.file.view(), facts, layer.style.scene});
    if (!panel) return pass_on(panel);
    const auto bytes = render::encode_png_of_few_colors(*panel);
    if (!bytes) return pass_on(bytes);
    std::string text = text_of_bytes(*bytes);
    std::string etag = fmt::format("\"{:016x}\"", xxh3_64(std::as_bytes(std::span(text))));
    return Kept{text_of(std::move(text)), std::move(etag), "image/png"};
}

render::EarthBox MapPictures::box_of(const std::string& domain, const grid::GridSpec& spec) {
    {
        const MutexLock lock(boxes_mutex_);
        if (const auto* known = boxes_.find({domain, spec})) return *known;
    }
    const render::EarthBox box = render::earth_box_of(spec);
    const MutexLock lock(boxes_mutex_);
    return boxes_.keep({domain, spec}, box);
}

int halvings_for(const render::PlaneWindow& window, const grid::GridSpec& spec,
                 std::size_t levels) {
    const double ratio = pixel_height_m(window, spec) / spec.cell_height_m();
    if (!(ratio > 1)) return 0;
    const int most = static_cast<int>(levels) - 1;
    return std::clamp(static_cast<int>(std::ceil(std::log2(ratio) - tolerated_octaves)), 0, most);
}

Result<UtcTime> time_of_grid(const Grids& grids, std::string_view domain, level2::Moment moment,
                             std::string_view text) {
    if (text == "latest") {
        const auto newest = grids.newest(domain, moment);
        if (newest) return *newest;
        return fail(ErrorCode::not_found, "there is no grid of {} in '{}'",
                    level2::moment_name(moment), printable(domain.substr(0, longest_shown_domain)));
    }
    return parse_utc(text, now_utc());
}

}  // namespace stormcellar::web
