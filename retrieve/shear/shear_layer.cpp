#include <cmath>
#include <optional>

#include "retrieve/shear/gate_shear.h"
#include "retrieve/shear/sweep_cells.h"

namespace stormcellar::retrieve {
namespace {

using grid::CellStatus;

void take_stronger(const ShearCell& from, ShearCell& to) {
    const int known = knowledge(from.status), known_before = knowledge(to.status);
    if (known > known_before || (known == known_before && from.status == CellStatus::value &&
                                 from.azimuthal_per_s > to.azimuthal_per_s))
        to = from;
}

// One sweep over the cells of layers.
class LayerSweep {
  public:
    LayerSweep(const level2::Sweep& sweep, const SweepFolds& folds, const SweepCells& cells,
               const GateShear& shear)
        : sweep_(sweep),
          moment_(sweep.moments[folds.moment]),
          folds_(folds),
          cells_(cells),
          shear_(shear),
          rows_(sweep.radials.size(), nullptr) {
        for (std::size_t row = 0; row < shear.rows.row_count(); ++row)
            rows_[shear.rows.radials[row]] = shear.gates.data() + row * shear.rows.gates;
    }

    void add_to(ShearLayer& layer) const {
        for (std::size_t azimuth = 0; azimuth < ShearLayer::azimuths; ++azimuth) {
            const std::size_t radial = cells_.radial(azimuth);
            if (radial == SweepCells::no_radial) continue;
            ShearCell* cells = layer.cells.data() + azimuth * ShearLayer::arcs;
            for (std::size_t arc = 0; arc < ShearLayer::arcs; ++arc)
                if (cells_.gate(arc).is_in(layer.bounds))
                    take_stronger(cell_of(radial, cells_.gate(arc)), cells[arc]);
        }
    }

  private:
    [[nodiscard]] ShearCell cell_of(std::size_t radial, const ArcGate& of) const {
        ShearCell cell{0, 0, of.height_m, CellStatus::value, sweep_.radials[radial].time};
        const auto gate = static_cast<std::size_t>(of.gate);
        const ShearOfGate* row = rows_[radial];
        if (row != nullptr && gate < shear_.rows.gates && row[gate].is_fitted) {
            cell.azimuthal_per_s = row[gate].azimuthal;
            cell.error_per_s = row[gate].azimuthal_error;
        } else {
            cell.status = status_without_fit(radial, of.gate);
        }
        return cell;
    }
    [[nodiscard]] CellStatus status_without_fit(std::size_t radial, std::int32_t gate) const {
        switch (moment_.status(radial, gate)) {
            case level2::GateStatus::no_data:
                return CellStatus::not_seen;
            case level2::GateStatus::range_folded:
                return CellStatus::range_folded;
            case level2::GateStatus::below_threshold:
                return CellStatus::no_echo;
            case level2::GateStatus::ambiguous:
            case level2::GateStatus::valid:
                break;
        }
        const std::size_t at =
            radial * static_cast<std::size_t>(moment_.gate_stride) + static_cast<std::size_t>(gate);
        if (rows_[radial] == nullptr) return CellStatus::not_seen;
        return folds_.ambiguous[at] != 0 ? CellStatus::ambiguous : CellStatus::no_echo;
    }

    const level2::Sweep& sweep_;
    const level2::SweepMoment& moment_;
    const SweepFolds& folds_;
    const SweepCells& cells_;
    const GateShear& shear_;
    std::vector<const ShearOfGate*> rows_;  // of each radial of the sweep; null if it has none
};

// Returns the range that the fits of all gates in the layers need, or none if the sweep passes
// through no layer.
std::optional<double> farthest_range_m(const SweepCells& cells,
                                       const std::vector<ShearLayer>& layers,
                                       const level2::SweepMoment& moment,
                                       const ShearOptions& options) {
    std::optional<double> farthest_m;
    for (std::size_t arc = 0; arc < ShearLayer::arcs; ++arc)
        for (const ShearLayer& layer : layers)
            if (cells.gate(arc).is_in(layer.bounds))
                farthest_m = moment.range_m(cells.gate(arc).gate);
    if (!farthest_m) return std::nullopt;
    constexpr int median_and_next = 2;
    return *farthest_m + options.kernel_range_m + median_and_next * moment.gate_spacing_m;
}

Result<void> add_sweep(const level2::Volume& volume, const SweepFolds& folds,
                       const grid::BeamGeometry& beam, const ShearOptions& options,
                       std::vector<ShearLayer>& layers) {
    if (const auto checked = check_folds(volume, folds); !checked) return pass_on(checked);
    const level2::Sweep& sweep = volume.sweeps[folds.sweep];
    const level2::SweepMoment& moment = sweep.moments[folds.moment];
    const SweepCells cells(sweep, moment, beam);
    if (cells.is_empty()) return {};
    const auto farthest_m = farthest_range_m(cells, layers, moment, options);
    if (!farthest_m) return {};
    const auto shear = gate_shear(volume, folds, options, *farthest_m);
    if (!shear) return pass_on(shear);
    const LayerSweep of_sweep(sweep, folds, cells, *shear);
    for (ShearLayer& layer : layers)
        of_sweep.add_to(layer);
    return {};
}

}  // namespace

int knowledge(CellStatus status) {
    switch (status) {
        case CellStatus::not_seen:
            return 0;
        case CellStatus::range_folded:
        case CellStatus::ambiguous:
            return 1;
        case CellStatus::no_echo:
            return 2;
        case CellStatus::value:
            return 3;
    }
    return 0;
}

Result<std::vector<ShearLayer>> shear_layers(const level2::Volume& volume,
                                             const Dealiased& dealiased,
                                             std::span<const LayerBounds> bounds,
                                             const ShearOptions& options) {
    if (const auto checked = check_shear_options(options); !checked) return pass_on(checked);
    std::vector<ShearLayer> layers;
    for (const LayerBounds& of : bounds) {
        if (!(std::isfinite(of.bottom_m) && of.bottom_m < of.top_m))
            return fail(ErrorCode::bad_argument, "a layer from {} to {} m is not in order",
                        of.bottom_m, of.top_m);
        layers.push_back(
            {volume.station, of, std::vector<ShearCell>(ShearLayer::azimuths * ShearLayer::arcs)});
    }
    const grid::BeamGeometry beam = beam_of(volume);
    for (const SweepFolds& folds : dealiased.sweeps)
        if (const auto added = add_sweep(volume, folds, beam, options, layers); !added)
            return pass_on(added);
    return layers;
}

Result<void> add_to_track(ShearLayer& track, const ShearLayer& layer) {
    if (track.cells.empty()) {
        track = layer;
        return {};
    }
    if (track.station != layer.station)
        return fail(ErrorCode::bad_argument, "a layer of '{}' cannot extend a track of '{}'",
                    layer.station, track.station);
    if (!(track.bounds == layer.bounds) || track.cells.size() != layer.cells.size())
        return fail(ErrorCode::bad_argument, "layers from {} to {} m and from {} to {} m differ",
                    track.bounds.bottom_m, track.bounds.top_m, layer.bounds.bottom_m,
                    layer.bounds.top_m);
    for (std::size_t i = 0; i < track.cells.size(); ++i)
        take_stronger(layer.cells[i], track.cells[i]);
    return {};
}

}  // namespace stormcellar::retrieve
