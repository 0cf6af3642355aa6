#include "stormcellar/retrieve/rain_rate.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::retrieve {
namespace {

constexpr double z_factor = 300, z_exponent = 1.4;
constexpr double kdp_factor = 44, kdp_exponent = 0.822;
constexpr double least_dbz_for_kdp = 40, least_kdp = 0.5, errors_of_kdp = 4;

}  // namespace

double rain_by_reflectivity_mm_per_h(double dbz) {
    if (std::isnan(dbz)) return dbz;
    const double z = std::pow(10, std::min(dbz, hail_cap_dbz) / 10);
    return std::pow(z / z_factor, 1 / z_exponent);
}

double rain_by_kdp_mm_per_h(double deg_per_km) {
    if (std::isnan(deg_per_km)) return deg_per_km;
    return kdp_factor * std::pow(std::max(deg_per_km, 0.0), kdp_exponent);
}

double rain_rate_mm_per_h(double dbz, double kdp_deg_per_km, double kdp_error) {
    const bool is_kdp_better = dbz >= least_dbz_for_kdp && kdp_deg_per_km >= least_kdp &&
                               kdp_deg_per_km >= errors_of_kdp * kdp_error;
    return is_kdp_better ? rain_by_kdp_mm_per_h(kdp_deg_per_km)
                         : rain_by_reflectivity_mm_per_h(dbz);
}

}  // namespace stormcellar::retrieve
