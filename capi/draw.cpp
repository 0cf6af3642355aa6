#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

#include "capi/draw_options.h"
#include "capi/grid_handle.h"
#include "capi/guarded.h"
#include "grid/plan/grid_effects.h"
#include "render/options/still_frame.h"
#include "render/options/sweep_source.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/render/png_file.h"
#include "stormcellar/render/product.h"
#include "stormcellar/retrieve/melting_layer.h"

struct stormcellar_picture {
    int width = 0, height = 0;
    std::vector<std::byte> bytes;
};

namespace stormcellar::capi {
namespace {

Result<std::vector<std::byte>> as_pixels(const render::Image& picture,
                                         const render::StillOptions& /*options*/) {
    const auto* const first = reinterpret_cast<const std::byte*>(picture.rgba.data());
    return std::vector<std::byte>(first, first + picture.rgba.size());
}

Result<std::vector<std::byte>> as_png(const render::Image& picture,
                                      const render::StillOptions& options) {
    return render::encode_png(picture, options.metadata);
}

const render::StillFormat pixels{.name = "RGBA",
                                 .endings = {},
                                 .media_type = "application/octet-stream",
                                 .encode_picture = as_pixels};
const render::StillFormat png{
    .name = "PNG", .endings = {}, .media_type = "image/png", .encode_picture = as_png};

// The choices for a picture, read from the options.
struct PictureWish {
    render::SceneOptions options;
    render::Scene scene;
    const render::StillFormat* format = nullptr;
};

Result<PictureWish> wish_of(const stormcellar_draw_options* options,
                            std::optional<level2::Moment> own_moment) {
    const auto all = take(options);
    if (!all) return pass_on(all);
    PictureWish wish;
    if (all->format != STORMCELLAR_RGBA && all->format != STORMCELLAR_PNG)
        return fail(ErrorCode::bad_argument, "there is no format {}", all->format);
    wish.format = all->format == STORMCELLAR_PNG ? &png : &pixels;
    auto scene_options = scene_options_of(*all, own_moment);
    if (!scene_options) return pass_on(scene_options);
    wish.options = std::move(*scene_options);
    auto scene = render::scene_of(wish.options);
    if (!scene) return pass_on(scene);
    wish.scene = std::move(*scene);
    if (render::marks_cells(wish.options))
        return fail(ErrorCode::unsupported,
                    "storm cells are marked by the program alone: stormcellar frame --overlay "
                    "cells");
    if (Status fits = render::check_single_grid(wish.scene.product); !fits) return pass_on(fits);
    return wish;
}

// Draws a grid or a sweep.
Status draw(PictureWish wish, const std::string& name, const grid::BrickView& view,
            const cache::GridDescription& description, stormcellar_picture** picture) {
    const render::StillSource source{name, view, description, wish.options};
    if (Status fitted = render::fit_to_grid(source, wish.scene); !fitted) return fitted;
    auto bytes = render::encode_still(source, wish.scene,
                                      {.format = *wish.format,
                                       .tiff = render::TiffContent::values,
                                       .error = {},
                                       .threads = wish.options.threads,
                                       .drawn = {}});
    if (!bytes) return pass_on(bytes);
    *picture = new stormcellar_picture{wish.scene.width, wish.scene.height, std::move(*bytes)};
    return {};
}

// An empty name stands for the names of the stations.
Status draw_cells(PictureWish wish, std::string name, const grid::Grid& cells,
                  stormcellar_picture** picture) {
    const auto bricks = grid::BrickGrid::from(cells, grid::default_quantization(cells.moment),
                                              wish.options.threads);
    if (name.empty()) name = fmt::format("{}", fmt::join(cells.provenance.stations, "+"));
    return draw(std::move(wish), name, bricks.view(), cache::describe(cells), picture);
}

Status draw_sweep(PictureWish wish, const stormcellar_volume& volume,
                  stormcellar_picture** picture) {
    const auto site = site_of(volume);
    if (!site) return pass_on(site);
    // The volume outlives the lookup, which therefore need not own it.
    const std::shared_ptr<const level2::Volume> borrowed(std::shared_ptr<void>{},
                                                         &volume.source.volume);
    const auto sweep = grid::SweepLookup::find(borrowed, *site, wish.scene.moment,
                                               grid::beam_width_of(site->icao) / 2,
                                               render::sweep_wish_of(wish.scene));
    if (!sweep) return pass_on(sweep);
    const auto description =
        render::describe_sweep(*sweep, render::plane_of_sweep(*sweep), volume.source, volume.file);
    grid::BrickView view;
    view.spec = &description.spec;
    view.sweep = &*sweep;
    return draw(std::move(wish), site->icao, view, description, picture);
}

// Notes the melting layer, after the notes of the volume, if a product of hail assumes another
// height of 0 C.
void compare_melting_layer(const render::Scene& scene, const grid::SourceVolume& source,
                           std::vector<std::string>& notes) {
    if (render::facts_of(scene.product).hail == nullptr) return;
    std::string note = retrieve::zero_c_note(source.volume, scene.freezing_levels.zero_c_m);
    const auto place = notes.begin() + static_cast<std::ptrdiff_t>(source.notes.size());
    if (!note.empty()) notes.insert(place, std::move(note));
}

Status draw_volume(const stormcellar_volume& volume, PictureWish wish,
                   stormcellar_picture** picture) {
    const auto derived =
        derived_volume(volume, {wish.scene.moment}, render::derived_options_of(wish.options));
    if (!derived) return pass_on(derived);
    const stormcellar_volume& shown = *derived ? **derived : volume;
    if (render::facts_of(wish.scene.product).is_of_sweep)
        return draw_sweep(std::move(wish), shown, picture);
    const auto site = site_of(shown);
    if (!site) return pass_on(site);
    grid::GridderOptions gridder;
    gridder.moment = wish.scene.moment;
    gridder.threads = wish.options.threads;
    auto made = grid_of(shown, *site, grid::default_spec(site->latitude_deg, site->longitude_deg),
                        grid::effects_of(gridder.moment), gridder);
    if (!made) return pass_on(made);
    compare_melting_layer(wish.scene, shown.source, made->provenance.notes);
    return draw_cells(std::move(wish), "", *made, picture);
}

Status begin(const void* object, const char* name, stormcellar_picture** picture) {
    if (object == nullptr || picture == nullptr)
        return is_null(object == nullptr ? name : "picture");
    *picture = nullptr;
    return {};
}

}  // namespace
}  // namespace stormcellar::capi

using namespace stormcellar;

stormcellar_code stormcellar_volume_draw(const stormcellar_volume* volume,
                                         const stormcellar_draw_options* options,
                                         stormcellar_picture** picture, stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        if (Status good = capi::begin(volume, "volume", picture); !good) return good;
        auto wish = capi::wish_of(options, std::nullopt);
        if (!wish) return pass_on(wish);
        return capi::draw_volume(*volume, std::move(*wish), picture);
    });
}

stormcellar_code stormcellar_grid_draw(const stormcellar_grid* grid,
                                       const stormcellar_draw_options* options,
                                       stormcellar_picture** picture, stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        if (Status good = capi::begin(grid, "grid", picture); !good) return good;
        auto wish = capi::wish_of(options, grid->grid.moment);
        if (!wish) return pass_on(wish);
        const Status fits = render::check_stored_derivation(wish->options, wish->scene.product);
        if (!fits) return fits;
        return capi::draw_cells(std::move(*wish), grid->domain, grid->grid, picture);
    });
}

void stormcellar_picture_free(stormcellar_picture* picture) {
    delete picture;
}

stormcellar_code stormcellar_picture_describe(const stormcellar_picture* picture,
                                              stormcellar_picture_facts* facts,
                                              stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        if (picture == nullptr) return capi::is_null("picture");
        stormcellar_picture_facts known{};
        known.width = picture->width;
        known.height = picture->height;
        known.bytes = picture->bytes.size();
        return capi::give(known, facts);
    });
}

stormcellar_code stormcellar_picture_bytes(const stormcellar_picture* picture,
                                           const uint8_t** bytes, stormcellar_error* error) {
    return capi::guarded(error, [&]() -> Status {
        if (picture == nullptr || bytes == nullptr)
            return capi::is_null(picture == nullptr ? "picture" : "bytes");
        *bytes = reinterpret_cast<const std::uint8_t*>(picture->bytes.data());
        return {};
    });
}
