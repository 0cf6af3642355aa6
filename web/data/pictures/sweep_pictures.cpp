#include "web/data/pictures/sweep_pictures.h"

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/printable.h"
#include "grid/place/source_volume.h"
#include "pipeline/drop/cataloged_volume.h"
#include "render/options/sweep_source.h"
#include "stormcellar/catalog/read_cataloged.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/retrieve/derived_moments.h"

namespace stormcellar::web {
namespace {

// Decodes the sweep that a panel shows. The picture names the volume and not the file, whose name
// may differ between machines. All panels are drawn on the plane of the first panel.
Result<PlacedSweep> decode_sweep(std::span<const std::byte> bytes, const std::string& file,
                                 std::optional<UtcTime> start, const render::PanelScene& panel,
                                 const retrieve::DerivedOptions& derived,
                                 const grid::GridSpec* plane, int threads) {
    const grid::SweepWish wish = render::sweep_wish_of(panel.scene);
    grid::SourceWish source_wish{
        .moments = {panel.moment},
        .choose_cuts =
            [&](const level2::Volume& volume) { return render::cuts_of_wish(volume, wish); },
        .threads = threads,
        .start = start};
    if (retrieve::must_derive(source_wish.moments, derived)) {
        source_wish.choose_cuts = {};  // all cuts help to dealias and to judge a cut
        source_wish.needs_all_moments = derived.quality > 0;
        source_wish.derive = [&](level2::Volume& volume) -> Result<std::vector<std::string>> {
            auto made = retrieve::add_derived_moments(volume, source_wish.moments, derived);
            if (!made) return pass_on(made);
            return std::move(made->notes);
        };
    }
    auto decoded = grid::decode_source(bytes, file, source_wish);
    if (!decoded) return pass_on(decoded);
    auto source = std::make_shared<const grid::SourceVolume>(std::move(*decoded));
    auto sweep = grid::SweepLookup::find({source, &source->volume}, source->site, panel.moment,
                                         grid::beam_width_of(source->site.icao) / 2, wish);
    if (!sweep) return fail(sweep.error().code, "{}: {}", file, sweep.error().message);
    auto description = render::describe_sweep(
        *sweep, plane != nullptr ? *plane : render::plane_of_sweep(*sweep), *source,
        start ? level2::volume_name(source->site.icao, *start) : std::string{});
    return PlacedSweep{std::move(source), std::move(*sweep), std::move(description)};
}

}  // namespace

// Returns the key of the picture. For a growing file, the key includes the state of the file on
// this machine.
std::string SweepPicture::key() const {
    const std::string state = catalog::has_final_hash(volume)
                                  ? std::string{}
                                  : fmt::format("{} {}", volume.path.native(), volume.modified_ns);
    return fmt::format("sweep {}\n{}\n{} {} {} {} {} {}", domain, style.key, grid_id,
                       volume.size_bytes, volume.content_hash, volume.volume.radial_count, chunks,
                       state);
}

std::string SweepPicture::etag() const {
    return etag_of_frame(key());
}

Result<std::optional<SweepPicture>> SweepPictures::find(const OpenGrid& grid, FrameStyle style) {
    const cache::GridDescription& description = grid.file.description();
    if (description.sites.size() != 1) {
        return fail(ErrorCode::bad_argument,
                    "a ppi shows a sweep of one radar, and '{}' is a mosaic of {}; name the domain "
                    "of a station",
                    printable(grid.domain), description.sites.size());
    }
    const auto catalog = catalog_->get();
    if (!catalog) {
        if (catalog.error().code == ErrorCode::not_found) return std::optional<SweepPicture>{};
        return pass_on(catalog);
    }
    auto volume = pipeline::find_volume_of_grid(**catalog, description.sites.front().icao,
                                                description.time, description.provenance.partial);
    if (!volume) return pass_on(volume);
    if (!*volume) return std::optional<SweepPicture>{};
    const auto chunks = pipeline::hash_of_growing_rows(**catalog, **volume);
    if (!chunks) return pass_on(chunks);
    return std::optional{
        SweepPicture{grid.domain, grid.id, std::move(**volume), *chunks, std::move(style)}};
}

Result<Kept> SweepPictures::find_or_draw(const SweepPicture& picture) {
    return options_.kept->find_or_make(picture.key(), [&] { return draw(picture); });
}

Result<std::vector<PlacedSweep>> SweepPictures::decode(const SweepPicture& picture) const {
    const auto catalog = catalog_->get();
    if (!catalog) return pass_on(catalog);
    const std::string file = picture.volume.path.filename().string();
    const auto start = picture.volume.volume.start_time;
    const auto raw = pipeline::read_cataloged_volume(**catalog, picture.volume);
    if (!raw) {
        const bool is_gone = raw.error().code == ErrorCode::not_found;
        return fail(raw.error().code, "the raw file {} {}", printable(file),
                    is_gone ? "is gone" : "cannot be read");
    }
    std::vector<PlacedSweep> sweeps;
    for (const render::PanelScene& panel : picture.style.panels) {
        const grid::GridSpec* const plane =
            sweeps.empty() ? nullptr : &sweeps.front().description.spec;
        auto sweep = decode_sweep(raw->bytes, file, start, panel,
                                  render::derived_options_of(picture.style.options), plane,
                                  options_.threads);
        if (!sweep) return pass_on(sweep);
        sweeps.push_back(std::move(*sweep));
    }
    return sweeps;
}

Result<Kept> SweepPictures::draw(const SweepPicture& picture) {
    const auto sweeps = decode(picture);
    if (!sweeps) return pass_on(sweeps);
    std::vector<DrawnPanel> panels;
    for (const PlacedSweep& placed : *sweeps) {
        grid::BrickView view;
        view.spec = &placed.description.spec;
        view.sweep = &placed.sweep;
        panels.push_back({view, &placed.description});
    }
    return draw_frame(picture.domain, picture.style, panels, picture.etag(), options_.threads);
}

}  // namespace stormcellar::web
