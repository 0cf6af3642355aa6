#include "render/frame/picture_metadata.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "base/printable.h"
#include "render/view/length_text.h"
#include "stormcellar/base/version.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/render/product.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "stormcellar/retrieve/hydrometeors.h"
#include "stormcellar/retrieve/melting_layer.h"

namespace stormcellar::render {
namespace {

// Replaces characters that are not printable ASCII, because names of files may contain any
// character.
std::string ascii_text(std::string_view text) {
    std::string safe = printable(text);
    std::replace_if(
        safe.begin(), safe.end(), [](char c) { return static_cast<unsigned char>(c) > 0x7E; }, '?');
    return safe;
}

std::string title_of(const PictureFacts& facts) {
    if (!facts.frames) return fmt::format("{} {}", facts.domain, format_utc(facts.first));
    return fmt::format("{} {} to {}", facts.domain, format_utc(facts.first),
                       format_utc(facts.last));
}

std::string grid_text(const grid::GridSpec& spec) {
    const bool in_degrees = spec.in_degrees();
    std::string text =
        fmt::format("{} x {} x {} cells of {:g} {}, {}", spec.nx, spec.ny, spec.nz(),
                    in_degrees ? spec.spacing_deg : spec.spacing_m / 1000,
                    in_degrees ? "degrees" : "km", grid::projection_name(spec.projection));
    text +=
        fmt::format(" about {:.4f} {:.4f}", spec.center_latitude_deg, spec.center_longitude_deg);
    if (!spec.levels_m.empty()) {
        text += fmt::format(", levels {:g} to {:g} km", spec.levels_m.front() / 1000,
                            spec.levels_m.back() / 1000);
    }
    return text;
}

std::string gridding_text(const grid::Provenance& provenance) {
    std::vector<std::string> parts{provenance.method, provenance.beam_model};
    if (!provenance.averaging.empty()) parts.push_back("averaged in " + provenance.averaging);
    if (!provenance.effects.empty()) parts.push_back(provenance.effects);
    std::erase(parts, "");
    return fmt::format("{}", fmt::join(parts, "; "));
}

std::string picture_text(const Scene& scene) {
    if (view_of(scene.product) != View::volume) {
        return fmt::format("{} x {} pixels", scene.width, scene.height);
    }
    const bool every_pixel = !(scene.pixel_tolerance > 0);
    return fmt::format("{} x {} pixels, {} slices, {} integration, light {}, {}{}", scene.width,
                       scene.height, scene.slices, integration_name(scene.integration),
                       light_names(scene.light),
                       every_pixel ? "a ray for every pixel" : "rays as many as the picture needs",
                       scene.curved_earth ? ", curved earth" : "");
}

}  // namespace

Metadata metadata_of(const PictureFacts& facts, const cache::GridDescription& grid,
                     const Scene& scene) {
    const grid::Provenance& provenance = grid.provenance;
    const std::string stations = fmt::format("{}", fmt::join(provenance.stations, " "));
    Metadata all;
    const auto add = [&](std::string keyword, const std::string& text) {
        if (!text.empty()) all.emplace_back(std::move(keyword), ascii_text(text));
    };
    add("Title", title_of(facts));
    add("Description",
        fmt::format("{}; gridded by {}, {}; {}", product_title(scene), provenance.method,
                    provenance.beam_model,
                    facts.frames
                        ? "stations " + stations
                        : fmt::format("from {}", fmt::join(provenance.source_files, " "))));
    add("First time", format_utc(facts.first));
    if (facts.frames) {
        add("Last time", format_utc(facts.last));
        add("Frames", fmt::format("{}", *facts.frames));
    }
    add("Domain", facts.domain);
    add("Stations", stations);
    add("Product", std::string(product_name(scene.product)));
    add("Moment", std::string(level2::moment_name(scene.moment)));
    add("Units", written_unit(scene).symbol);
    if (facts_of(scene.product).hail != nullptr)
        add("Freezing levels",
            fmt::format("0 C at {:g} m, -20 C at {:g} m above sea level, assumed",
                        scene.freezing_levels.zero_c_m, scene.freezing_levels.minus_20_c_m));
    if (facts_of(scene.product).hail != nullptr)
        add("Melting layer", retrieve::zero_c_in_notes(provenance.notes));
    for (const std::string& note : provenance.notes)
        if (note.starts_with(retrieve::hydrometeor_words))
            add("Melting layer", note.substr(retrieve::hydrometeor_words.size()));
    add("Hail error", facts.hail);
    add("Storm cells", facts.cells);
    add("Shapes", facts.shapes);
    add("Grid", grid_text(grid.spec));
    add("Gridding", gridding_text(provenance));
    add("Gridding error", provenance.predicted_error);
    if (!facts.frames) add("Notes", fmt::format("{}", fmt::join(provenance.notes, "; ")));
    add("Between grids", facts.between);
    add("Picture", picture_text(scene));
    add("Picture error", facts.error);
    if (const auto storm = retrieve::motion_in_notes(provenance.notes);
        storm && scene.moment == level2::Moment::srv)
        add("Storm motion", motion_text(*storm, scene.units));
    add("Software", fmt::format("stormcellar {}", software_version));
    return all;
}

}  // namespace stormcellar::render
