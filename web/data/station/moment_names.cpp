#include "web/data/station/moment_names.h"

#include "export/exchange_names.h"

namespace stormcellar::web {
namespace {

struct NameAndUnit {
    std::string_view long_name = {}, unit = {};
};
NameAndUnit name_and_unit(level2::Moment moment) {
    using level2::Moment;
    constexpr std::string_view speed = "meters per seconds";
    switch (moment) {
        case Moment::ref:
            return {"Equivalent reflectivity factor H", "dBZ"};
        case Moment::vel:
            return {"Radial velocity of scatterers away from instrument H", speed};
        case Moment::sw:
            return {"Doppler spectrum width H", speed};
        case Moment::zdr:
            return {"Log differential reflectivity H/V", "dB"};
        case Moment::phi:
            return {"Differential phase HV", "degrees"};
        case Moment::rho:
            return {"Correlation coefficient HV", "unitless"};
        case Moment::cfp:
            return {"Clutter Correction H", "dB"};
        case Moment::veld:
            return {"Dealiased radial velocity H", speed};
        case Moment::srv:
        case Moment::azsh:
        case Moment::divg:
        case Moment::pow:
        case Moment::kdp:
        case Moment::rate:
        case Moment::hca:
            break;
    }
    return {};
}

}  // namespace

MomentNames fm301_names(level2::Moment moment) {
    const NameAndUnit named = name_and_unit(moment);
    if (named.unit.empty())
        return {.name = level2::moment_name(moment), .unit = level2::moment_units(moment)};
    const netcdf::ExchangeNames names = netcdf::exchange_names_of(moment);
    return {.name = names.name,
            .standard_name = names.standard_name,
            .long_name = named.long_name,
            .unit = named.unit};
}

}  // namespace stormcellar::web
