#include "cli/picture/swept_volume.h"

#include <array>
#include <utility>

#include "cli/grid/grid_files.h"
#include "render/options/sweep_source.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::cli {
namespace {

// Returns the plane of the sweep, changed by the options.
Result<grid::GridSpec> plane_of(const SweptVolume& volume, const grid::SweepLookup& sweep) {
    const grid::GridSpec whole = render::plane_of_sweep(sweep);
    GridRequest request = volume.request;
    if (!volume.spacing_given) {
        request.spacing = whole.spacing_m / 1000;
        request.spacing_unit = SizeUnit::km;
    }
    if (!request.extent_given) {
        const double km = whole.nx * whole.spacing_m / 1000;
        request.extent = {km, km};
        request.extent_unit = SizeUnit::km;
    }
    request.levels_m = whole.levels_m;
    return spec_about(request, whole.center_latitude_deg, whole.center_longitude_deg);
}

ChooseCuts chooser_of(const render::Scene* shown, const GridRequest& request) {
    if (shown == nullptr) return {};
    return [wish = render::sweep_wish_of(*shown, request.frame_time)](
               const level2::Volume& volume) { return render::cuts_of_wish(volume, wish); };
}

SweptVolume swept_volume(std::string file, GridRequest request, const GridOptions& options,
                         SourceVolume source) {
    auto volumes = std::make_shared<std::vector<SourceVolume>>();
    volumes->push_back(std::move(source));
    return {std::move(file), std::move(request), options.spacing_km || options.spacing_deg,
            std::move(volumes)};
}

}  // namespace

Result<SweptVolume> read_sweeps(GridOptions options, const render::Scene* shown) {
    const auto inputs = find_inputs(options);
    if (!inputs) return pass_on(inputs);
    if (options.files.size() != 1) {
        return fail(ErrorCode::bad_argument, "a ppi is drawn of one file, not of {}",
                    options.files.size());
    }
    auto request = parse_request(options);
    if (!request) return pass_on(request);
    request->inputs = *inputs;
    const std::string& file = options.files.front();
    auto source = load_volume(file, *request, chooser_of(shown, *request));
    if (!source) return pass_on(source);
    return swept_volume(file, std::move(*request), options, std::move(*source));
}

Result<SweptVolume> decode_sweeps(const RawVolume& raw, const GridOptions& options,
                                  const render::Scene* shown) {
    auto request = parse_request(options);
    if (!request) return pass_on(request);
    auto source =
        decode_volume(raw.bytes, raw.file, *request, raw.start, chooser_of(shown, *request));
    if (!source) return pass_on(source);
    return swept_volume(raw.file, std::move(*request), options, std::move(*source));
}

Result<PlacedSweep> place_sweep(const SweptVolume& volume, const render::Scene& scene,
                                const grid::GridSpec* plane) {
    const SourceVolume& source = volume.source();
    auto sweep =
        grid::SweepLookup::find({volume.volumes, &source.volume}, source.site,
                                volume.request.moment, grid::beam_width_of(source.site.icao) / 2,
                                render::sweep_wish_of(scene, volume.request.frame_time));
    if (!sweep) return fail(sweep.error().code, "{}: {}", volume.file, sweep.error().message);
    auto own = plane != nullptr ? Result<grid::GridSpec>{*plane} : plane_of(volume, *sweep);
    if (!own) return pass_on(own);
    auto description = render::describe_sweep(*sweep, std::move(*own), source, volume.file);
    return PlacedSweep{std::move(description), std::move(*sweep)};
}

std::vector<double> elevations_of(const SweptVolume& volume) {
    const SourceVolume& source = volume.source();
    return grid::elevations_deg(source.volume, volume.request.moment,
                                grid::beam_width_of(source.site.icao) / 2);
}

}  // namespace stormcellar::cli
