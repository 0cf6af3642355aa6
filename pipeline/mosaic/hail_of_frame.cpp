#include "pipeline/mosaic/hail_of_frame.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/mosaic/time_interpolation.h"
#include "pipeline/mosaic/frame_parts.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "retrieve/hail/hail_mosaic.h"

namespace stormcellar::pipeline {
namespace {

// Returns the method by which a frame was made for its instant, as its provenance names it.
grid::TimeMethod method_of(const cache::GridDescription& frame) {
    constexpr std::string_view word = "time: ";
    const std::string& effects = frame.provenance.effects;
    const std::size_t at = effects.rfind(word);
    if (at == effects.npos) return FrameOptions{}.time;
    const std::size_t from = at + word.size();
    const std::string_view name =
        std::string_view(effects).substr(from, effects.find(',', from) - from);
    return grid::time_method_from_name(name).value_or(FrameOptions{}.time);
}

// Opens the partials of one radar that the frame lists.
Result<std::vector<cache::GridFile>> open_parts(const cache::StoreReader& store,
                                                const std::string& domain,
                                                const cache::GridDescription& frame,
                                                const std::string& icao) {
    std::vector<cache::GridFile> files;
    for (const grid::FramePart& part : frame.provenance.parts) {
        if (part.icao != icao) continue;
        const auto path = store.path_of(domain + "." + icao, level2::Moment::ref, part.time);
        if (!path) return pass_on(path);
        auto file = cache::GridFile::open(*path);
        const bool is_gone = !file && file.error().code == ErrorCode::not_found;
        if (!file && !is_gone) return pass_on(file);
        const bool is_it =
            file && fingerprint_of({&file->description(), file->view()}) == part.fingerprint;
        if (!is_it)
            return fail(ErrorCode::not_found, "the grid of {} at {} is no longer in the cache",
                        icao, format_utc(part.time));
        files.push_back(std::move(*file));
    }
    return files;
}

// Makes the grid of one radar for the instant of the frame, on its own window.
Result<grid::Grid> grid_of_radar(const std::vector<cache::GridFile>& files,
                                 const cache::GridDescription& frame, int threads) {
    std::vector<PartialView> partials;
    for (const cache::GridFile& file : files)
        partials.push_back({&file.description(), file.view(), &file});
    FrameOptions options;
    options.time = method_of(frame);
    options.threads = threads;
    GeometryCache geometries(1);
    const auto made =
        make_frame(partials.front().description->spec, partials, frame.time, options, geometries);
    if (!made) return pass_on(made);
    return grid::to_dense(made->mosaic.cells.view());
}

}  // namespace

bool is_of_several(const cache::GridDescription& frame) {
    return frame.moment == level2::Moment::ref && frame.sites.size() > 1;
}

Result<HailFrame> hail_of_frame(const cache::StoreReader& store, const HailRequest& request,
                                const cache::GridDescription& frame, const grid::BrickView& view) {
    const auto cells = static_cast<double>(frame.spec.cell_count());
    if (cells > request.most_cells)
        return fail(ErrorCode::over_budget, "{:.0f} million cells are too many", cells / 1e6);
    if (frame.provenance.parts.empty())
        return fail(ErrorCode::not_found, "it does not list the grids of its radars");
    auto hail = retrieve::HailMosaic::make(frame.spec, request.levels);
    if (!hail) return pass_on(hail);
    grid::Grid mosaic = grid::to_dense(view);
    for (const grid::SitePosition& site : frame.sites) {
        const auto files = open_parts(store, request.domain, frame, site.icao);
        if (!files) return pass_on(files);
        if (files->empty()) continue;
        const auto radar = grid_of_radar(*files, frame, request.threads);
        if (!radar) return pass_on(radar);
        if (Status added = hail->add(*radar, mosaic); !added) return pass_on(added);
    }
    HailFrame made{frame, grid::BrickGrid::from(mosaic, view.quantization, request.threads)};
    made.description.provenance.notes.emplace_back(merged_hail_note);
    return made;
}

}  // namespace stormcellar::pipeline
