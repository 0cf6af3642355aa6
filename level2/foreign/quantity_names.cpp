#include "level2/foreign/quantity_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>

#include "base/checksum.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::level2 {
namespace {

struct Name {
    std::string_view name;
    Quantity quantity;
};

// Names in upper case, besides those of the moments themselves. Quantities without filters or
// corrections have higher ranks.
constexpr auto names = std::to_array<Name>({
    {"DBZH", {Moment::ref, 0}},
    {"DBZ", {Moment::ref, 1}},
    {"CZ", {Moment::ref, 1}},
    {"REFLECTIVITY", {Moment::ref, 1}},
    {"CORRECTED_REFLECTIVITY", {Moment::ref, 0}},
    {"DBZHC", {Moment::ref, 1}},
    {"DBZHC_F", {Moment::ref, 1}},
    {"DBZ_F", {Moment::ref, 1}},
    {"DZ", {Moment::ref, 2}},
    {"TH", {Moment::ref, 3}},
    {"DBTH", {Moment::ref, 3}},
    {"DBZV", {Moment::ref, 4}},
    {"TV", {Moment::ref, 5}},
    {"VRADH", {Moment::vel, 0}},
    {"VRAD", {Moment::vel, 1}},
    {"VR", {Moment::vel, 1}},
    {"VELOCITY", {Moment::vel, 1}},
    {"VELH", {Moment::vel, 1}},
    {"VEL_F", {Moment::vel, 2}},
    {"V", {Moment::vel, 2}},
    {"VRADV", {Moment::vel, 3}},
    {"WRADH", {Moment::sw, 0}},
    {"WRAD", {Moment::sw, 1}},
    {"WIDTH", {Moment::sw, 1}},
    {"SPECTRUM_WIDTH", {Moment::sw, 1}},
    {"WIDTH_F", {Moment::sw, 2}},
    {"W", {Moment::sw, 2}},
    {"WRADV", {Moment::sw, 3}},
    {"DIFFERENTIAL_REFLECTIVITY", {Moment::zdr, 1}},
    {"ZDR_F", {Moment::zdr, 1}},
    {"UZDR", {Moment::zdr, 2}},
    {"PHIDP", {Moment::phi, 0}},
    {"DIFFERENTIAL_PHASE", {Moment::phi, 1}},
    {"PHIDP_F", {Moment::phi, 1}},
    {"UPHIDP", {Moment::phi, 2}},
    {"RHOHV", {Moment::rho, 0}},
    {"CROSS_CORRELATION_RATIO", {Moment::rho, 1}},
    {"RHOHV_F", {Moment::rho, 1}},
    {"URHOHV", {Moment::rho, 2}},
    {"CCORH", {Moment::cfp, 0}},
});

constexpr std::size_t station_letters = 4;

std::string upper(std::string_view text) {
    std::string made{text};
    for (char& letter : made)
        letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    return made;
}

// Returns the letters and digits of the text, in upper case.
std::string plain(std::string_view text) {
    std::string made = upper(text);
    std::erase_if(made, [](char c) { return (c < 'A' || c > 'Z') && (c < '0' || c > '9'); });
    return made;
}

// Returns the value of a key in a source of ODIM_H5, such as NOD.
std::string value_of_key(std::string_view source, std::string_view key) {
    while (!source.empty()) {
        const std::string_view part = source.substr(0, source.find(','));
        if (part.size() > key.size() && part.starts_with(key) && part[key.size()] == ':')
            return plain(part.substr(key.size() + 1));
        source.remove_prefix(std::min(source.size(), part.size() + 1));
    }
    return {};
}

bool is_elsewhere(const std::string& name, const VolumeBlock& position) {
    const auto station = find_station(name);
    if (!station) return false;
    return std::abs(station->latitude_deg - static_cast<double>(position.latitude_deg)) > 1 ||
           std::abs(station->longitude_deg - static_cast<double>(position.longitude_deg)) > 1;
}

}  // namespace

std::optional<Quantity> quantity_named(std::string_view name) {
    const std::string wanted = upper(name);
    const auto moment = moment_from_name(wanted);
    if (moment && !facts_of(*moment).is_derived) return Quantity{*moment, 0};
    const auto found = std::ranges::find(names, wanted, &Name::name);
    return found == names.end() ? std::nullopt : std::optional{found->quantity};
}

std::optional<Quantity> quantity_of_standard_name(std::string_view name) {
    if (name.empty()) return std::nullopt;
    constexpr int by_standard_name = 6;
    for (const MomentFacts& facts : moment_facts) {
        if (!facts.is_derived && (facts.netcdf.cfradial == name || facts.netcdf.cf == name))
            return Quantity{facts.moment, by_standard_name};
    }
    return std::nullopt;
}

std::string station_of(std::string_view name, const VolumeBlock& position) {
    std::string made;
    if (name.find(':') != std::string_view::npos) {
        made = value_of_key(name, "NOD");
        if (made.size() > station_letters) made.erase(1, 1);
        for (const std::string_view key : {"RAD", "WIGOS", "WMO", "PLC", "CMT"}) {
            if (made.empty()) made = value_of_key(name, key);
        }
    }
    if (made.empty()) made = plain(name);
    if (made.empty()) return {};
    if (made[0] < 'A') {
        // The last digits differ most.
        if (made.size() >= station_letters) made.erase(0, made.size() - station_letters + 1);
        made.insert(0, "X");
    }
    made.resize(station_letters, 'X');
    if (!is_elsewhere(made, position)) return made;
    std::uint64_t sum = xxh3_64(std::as_bytes(std::span{name.data(), name.size()}));
    constexpr std::uint64_t signs = 36;
    for (std::size_t i = 2; i < station_letters; ++i, sum /= signs)
        made[i] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"[sum % signs];
    return made;
}

}  // namespace stormcellar::level2
