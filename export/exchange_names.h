// export/exchange_names.h -- the names that other volume formats give to our moments; internal to
// export.
//
// Source    ODIM_H5 2.4 (EUMETNET OPERA, 2021), table of quantities; WMO FM 301-2022 and CfRadial
//           2.1, section 5; UF as Py-ART, RSL and Radx read it.
// Threads   A constant and a pure function.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "stormcellar/level2/moment.h"

namespace stormcellar::netcdf {

struct ExchangeNames {
    level2::Moment moment = level2::Moment::ref;
    std::string_view name;           // in ODIM_H5 and FM 301; ours if these have no name
    std::string_view standard_name;  // of FM 301; empty if it has none
    std::string_view uf;             // two letters
};

// In this table, a name that is the same as ours is empty.
inline constexpr auto exchange_name_rows = std::to_array<ExchangeNames>({
    {level2::Moment::ref, "DBZH", "radar_equivalent_reflectivity_factor_h", "DZ"},
    {level2::Moment::vel, "VRADH", "radial_velocity_of_scatterers_away_from_instrument_h", "VR"},
    {level2::Moment::sw, "WRADH", "radar_doppler_spectrum_width_h", ""},
    {level2::Moment::zdr, "", "radar_differential_reflectivity_hv", "ZD"},
    {level2::Moment::phi, "PHIDP", "radar_differential_phase_hv", "PH"},
    {level2::Moment::rho, "RHOHV", "radar_correlation_coefficient_hv", "RH"},
    {level2::Moment::cfp, "CCORH", "radar_clutter_correction_h", "CF"},
    {level2::Moment::veld, "VRADDH", "radial_velocity_of_scatterers_away_from_instrument_h", "VE"},
    {level2::Moment::srv, "", "", "SV"},
    {level2::Moment::azsh, "AZSHEAR", "", "AS"},
    {level2::Moment::divg, "DIVERGENCE", "", "DV"},
    {level2::Moment::pow, "", "", "PW"},
    {level2::Moment::kdp, "", "radar_specific_differential_phase_hv", "KD"},
    {level2::Moment::rate, "", "rainfall_rate", "RR"},
    {level2::Moment::hca, "", "", "HC"},
});
static_assert(level2::has_a_row_for_each_moment(exchange_name_rows));

[[nodiscard]] constexpr ExchangeNames exchange_names_of(level2::Moment moment) {
    ExchangeNames names = exchange_name_rows[static_cast<std::size_t>(moment)];
    if (names.name.empty()) names.name = level2::moment_name(moment);
    if (names.uf.empty()) names.uf = level2::moment_name(moment);
    return names;
}

}  // namespace stormcellar::netcdf
