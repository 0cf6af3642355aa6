#include "export/moment_text.h"

namespace stormcellar::netcdf {

MomentText text_of(level2::Moment moment) {
    switch (moment) {
        case level2::Moment::ref:
            return {"reflectivity", "equivalent_reflectivity_factor",
                    "equivalent_reflectivity_factor"};
        case level2::Moment::vel:
            return {"radial velocity, away from the radar, as measured (aliased)",
                    "radial_velocity_of_scatterers_away_from_instrument",
                    "radial_velocity_of_scatterers_away_from_instrument"};
        case level2::Moment::sw:
            return {"spectrum width of radial velocity", nullptr, "doppler_spectrum_width"};
        case level2::Moment::zdr:
            return {"differential reflectivity", nullptr, "log_differential_reflectivity_hv"};
        case level2::Moment::phi:
            return {"differential phase, as measured (wrapped)", nullptr, "differential_phase_hv"};
        case level2::Moment::rho:
            return {"correlation coefficient", nullptr, "cross_correlation_ratio_hv"};
        case level2::Moment::cfp:
            return {"clutter filter power removed", nullptr, nullptr};
    }
    return {"", nullptr, nullptr};
}

}  // namespace stormcellar::netcdf
