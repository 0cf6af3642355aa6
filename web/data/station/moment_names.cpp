#include "web/data/station/moment_names.h"

namespace stormcellar::web {

MomentNames fm301_names(level2::Moment moment) {
    using level2::Moment;
    switch (moment) {
        case Moment::ref:
            return {"DBZH", "radar_equivalent_reflectivity_factor_h",
                    "Equivalent reflectivity factor H", "dBZ"};
        case Moment::vel:
            return {"VRADH", "radial_velocity_of_scatterers_away_from_instrument_h",
                    "Radial velocity of scatterers away from instrument H", "meters per seconds"};
        case Moment::sw:
            return {"WRADH", "radar_doppler_spectrum_width_h", "Doppler spectrum width H",
                    "meters per seconds"};
        case Moment::zdr:
            return {"ZDR", "radar_differential_reflectivity_hv",
                    "Log differential reflectivity H/V", "dB"};
        case Moment::phi:
            return {"PHIDP", "radar_differential_phase_hv", "Differential phase HV", "degrees"};
        case Moment::rho:
            return {"RHOHV", "radar_correlation_coefficient_hv", "Correlation coefficient HV",
                    "unitless"};
        case Moment::cfp:
            return {"CCORH", "radar_clutter_correction_h", "Clutter Correction H", "dB"};
        case Moment::veld:
        case Moment::srv:
        case Moment::azsh:
        case Moment::divg:
        case Moment::pow:
        case Moment::kdp:
        case Moment::rate:
        case Moment::hca:
            break;  // no raw file has a derived moment
    }
    return {.name = level2::moment_name(moment), .unit = level2::moment_units(moment)};
}

}  // namespace stormcellar::web
