#include "stormcellar/retrieve/velocity_shear.h"

#include <limits>

#include "retrieve/shear/gate_shear.h"

namespace stormcellar::retrieve {

Result<SweepShear> sweep_shear(const level2::Volume& volume, const SweepFolds& folds,
                               const ShearOptions& options) {
    const auto found = gate_shear(volume, folds, options, std::numeric_limits<double>::max());
    if (!found) return pass_on(found);
    const std::size_t gates = folds.folds.size();
    SweepShear shear{folds.sweep,
                     folds.moment,
                     found->rows.elevation_deg,
                     std::vector<std::uint8_t>(gates),
                     std::vector<float>(gates),
                     std::vector<float>(gates),
                     std::vector<float>(gates),
                     std::vector<float>(gates)};
    const level2::SweepMoment& moment = volume.sweeps[folds.sweep].moments[folds.moment];
    for (std::size_t row = 0; row < found->rows.row_count(); ++row) {
        const ShearOfGate* from = found->gates.data() + row * found->rows.gates;
        const std::size_t first =
            found->rows.radials[row] * static_cast<std::size_t>(moment.gate_stride);
        for (std::size_t gate = 0; gate < found->rows.gates; ++gate) {
            const std::size_t to = first + gate;
            shear.is_fitted[to] = from[gate].is_fitted ? 1 : 0;
            shear.azimuthal_per_s[to] = from[gate].azimuthal;
            shear.azimuthal_error_per_s[to] = from[gate].azimuthal_error;
            shear.divergence_per_s[to] = from[gate].divergence;
            shear.divergence_error_per_s[to] = from[gate].divergence_error;
        }
    }
    return shear;
}

}  // namespace stormcellar::retrieve
