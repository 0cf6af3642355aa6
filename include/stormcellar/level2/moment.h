// stormcellar/level2/moment.h -- lists the moments, which a radar measures or the program derives,
// with the facts about each.
//
// This is the only list of moments. Two rooms add facts in tables that have a row for every moment;
// code with a missing row does not compile:
//   grid    grid/cells/moment_rules.cpp   how values are stored, mixed and compared
//   render  render/color/moment_look.cpp  title, colors, opacity
// CONTRIBUTING.md says how to add a moment.
//
// Threads   Constants and pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stormcellar::level2 {

// Grid files hold these numbers, so do not change them; add a new moment at the end.
enum class Moment : std::uint8_t {
    ref,
    vel,
    sw,
    zdr,
    phi,
    rho,
    cfp,
    veld,
    srv,
    azsh,
    divg,
    pow,
    kdp,
    rate,
    hca
};

// The circle on which the values of a moment wrap around.
enum class Circle : std::uint8_t {
    none,
    nyquist,    // from -Nyquist to +Nyquist; each radial has its own Nyquist velocity
    full_turn,  // from 0 to 360 degrees
};

// Names of a moment in netCDF files; empty if the moment has none.
struct NetcdfNames {
    std::string_view long_name = {};
    std::string_view cf = {};        // standard name in CF's own table
    std::string_view cfradial = {};  // standard name proposed by CfRadial 1.4, section 6.1
    std::string_view variable = {};  // in CfRadial; empty: the moment's name
};

struct MomentFacts {
    Moment moment = Moment::ref;
    std::string_view name = {};   // in messages (filled with blanks to three), paths and options
    std::string_view units = {};  // as CF writes them; "1" for a number without a unit
    NetcdfNames netcdf = {};
    Circle circle = Circle::none;
    // True if values on both sides of zero are equally strong, as velocities are, so that the
    // strongest of several values is the one farthest from zero.
    bool is_signed = false;
    // True if the radar measures the moment with a high pulse rate, which makes the unambiguous
    // range short.
    bool is_doppler = false;
    // The lowest code that is a value. If this is 2, code 0 is below threshold and code 1 range
    // folded. If it is larger, all codes below it are flags (ICD 2620002, table XVII-I).
    std::uint16_t first_valid_code = 2;
    // True if no radar sends the moment: the room `retrieve` derives it. Code 2 is ambiguous then.
    bool is_derived = false;
    // The measured moment whose gates a derived moment has.
    Moment measured = Moment::vel;
    // True if a value is the number of a class. Such values have no mean, so they are shown sweep
    // by sweep, and a cell of a grid has the class of the nearest gate.
    bool is_categorical = false;
};

inline constexpr auto moment_facts = std::to_array<MomentFacts>({
    {Moment::ref,
     "REF",
     "dBZ",
     {"reflectivity", "equivalent_reflectivity_factor", "equivalent_reflectivity_factor"}},
    {Moment::vel,
     "VEL",
     "m/s",
     {"radial velocity, away from the radar, as measured (aliased)",
      "radial_velocity_of_scatterers_away_from_instrument",
      "radial_velocity_of_scatterers_away_from_instrument"},
     Circle::nyquist,
     true,
     true},
    {Moment::sw,
     "SW",
     "m/s",
     {"spectrum width of radial velocity", "", "doppler_spectrum_width"},
     Circle::none,
     false,
     true},
    {Moment::zdr,
     "ZDR",
     "dB",
     {"differential reflectivity", "", "log_differential_reflectivity_hv"}},
    {Moment::phi,
     "PHI",
     "degree",
     {"differential phase, as measured (wrapped)", "", "differential_phase_hv"},
     Circle::full_turn},
    {Moment::rho, "RHO", "1", {"correlation coefficient", "", "cross_correlation_ratio_hv"}},
    {Moment::cfp, "CFP", "dB", {"clutter filter power removed"}, Circle::none, false, false, 8},
    {Moment::veld,
     "VELD",
     "m/s",
     {"radial velocity, away from the radar, dealiased",
      "radial_velocity_of_scatterers_away_from_instrument",
      "corrected_radial_velocity_of_scatterers_away_from_instrument", "VEL_dealiased"},
     Circle::none,
     true,
     true,
     3,
     true},
    {Moment::srv,
     "SRV",
     "m/s",
     {"radial velocity, away from the radar, dealiased, relative to a storm"},
     Circle::none,
     true,
     true,
     3,
     true},
    {Moment::azsh,
     "AZSH",
     "0.001/s",
     {"azimuthal shear of the radial velocity, counterclockwise", "", "", "AZSHEAR"},
     Circle::none,
     true,
     true,
     3,
     true},
    {Moment::divg,
     "DIVG",
     "0.001/s",
     {"divergence of the radial velocity along the beam, over the ground", "", "", "DIVERGENCE"},
     Circle::none,
     true,
     true,
     3,
     true},
    {Moment::pow,
     "POW",
     "1",
     {"probability that the echo is weather"},
     Circle::none,
     false,
     false,
     3,
     true,
     Moment::ref},
    {Moment::kdp,
     "KDP",
     "degree/km",
     {"specific differential phase", "", "specific_differential_phase_hv"},
     Circle::none,
     false,
     false,
     3,
     true,
     Moment::phi},
    {Moment::rate,
     "RATE",
     "mm/h",
     {"rain rate", "rainfall_rate", "radar_estimated_rain_rate"},
     Circle::none,
     false,
     false,
     3,
     true,
     Moment::ref},
    {Moment::hca,
     "HCA",
     "1",
     {"hydrometeor class: 10 biological, 20 ground clutter, 30 ice crystals, 40 dry snow, 50 wet "
      "snow, 60 rain, 70 heavy rain, 80 big drops, 90 graupel, 100 hail",
      "", "radar_echo_classification"},
     Circle::none,
     false,
     false,
     3,
     true,
     Moment::ref,
     true},
});
inline constexpr int moment_count = static_cast<int>(moment_facts.size());

// Returns true if `rows` has one row for each moment, in the order of the enumeration. Each table
// of moments asserts this.
template <class Rows>
[[nodiscard]] constexpr bool has_a_row_for_each_moment(const Rows& rows) {
    if (std::size(rows) != moment_facts.size()) return false;
    for (std::size_t i = 0; i < std::size(rows); ++i) {
        if (rows[i].moment != static_cast<Moment>(i)) return false;
    }
    return true;
}
static_assert(has_a_row_for_each_moment(moment_facts));

inline constexpr std::array<Moment, moment_count> all_moments = [] {
    std::array<Moment, moment_count> moments{};
    for (std::size_t i = 0; i < moments.size(); ++i)
        moments[i] = moment_facts[i].moment;
    return moments;
}();

[[nodiscard]] constexpr const MomentFacts& facts_of(Moment moment) {
    return moment_facts[static_cast<std::size_t>(moment)];
}
[[nodiscard]] constexpr std::string_view moment_name(Moment moment) {
    return facts_of(moment).name;
}
[[nodiscard]] constexpr std::string_view moment_units(Moment moment) {
    return facts_of(moment).units;
}
[[nodiscard]] constexpr bool is_circular(Moment moment) {
    return facts_of(moment).circle != Circle::none;
}

// Returns the measured moment from which a derived moment comes, or the moment itself.
[[nodiscard]] constexpr Moment measured_moment(Moment moment) {
    return facts_of(moment).is_derived ? facts_of(moment).measured : moment;
}

// Returns true for moments that come from dealiased velocities.
[[nodiscard]] constexpr bool is_dealiased(Moment moment) {
    return facts_of(moment).is_derived && facts_of(moment).measured == Moment::vel;
}

// Returns true if all measured moments help to derive the moment.
[[nodiscard]] constexpr bool uses_all_moments(Moment moment) {
    return facts_of(moment).is_derived && facts_of(moment).measured != Moment::vel;
}

// Finds a moment by its name in upper case.
[[nodiscard]] std::optional<Moment> moment_from_name(std::string_view name);
// Returns a list of all names for a text: moment_names(", ", " or ") is "REF, VEL, ... RHO or CFP".
[[nodiscard]] std::string moment_names(std::string_view between, std::string_view before_last);

}  // namespace stormcellar::level2
