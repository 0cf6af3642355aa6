#include "web/data/station/station_layout.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "export/zarr_chunks.h"
#include "web/data/station/moment_names.h"

namespace stormcellar::web {
namespace {

constexpr const char* since_1970 = "milliseconds since 1970-01-01T00:00:00Z";
constexpr std::string_view status_ending = "_status";
constexpr const char* speed_unit = "meters per seconds";

// Texts of a sweep that are the same in all sweeps.
struct SweepText {
    std::string_view name, text;
};
constexpr std::array<SweepText, 3> sweep_texts = {
    {{"sweep_mode", "azimuth_surveillance"}, {"prt_mode", "not_set"}, {"follow_mode", "not_set"}}};

struct RadialArray {
    std::string_view name;
    RadialFact fact;
};
constexpr std::array<RadialArray, 4> radial_arrays = {{{"time", RadialFact::time},
                                                       {"ray_azimuth", RadialFact::azimuth},
                                                       {"elevation", RadialFact::elevation},
                                                       {"nyquist_velocity", RadialFact::nyquist}}};

ZarrJson attributes_of(RadialFact fact) {
    switch (fact) {
        case RadialFact::time:
            return {{"standard_name", "time"},
                    {"units", since_1970},
                    {"calendar", "proleptic_gregorian"},
                    {"_FillValue", no_time_ms}};
        case RadialFact::azimuth:
            return {{"long_name", "Azimuth of the ray"}, {"units", "degrees"}};
        case RadialFact::elevation:
            return {{"standard_name", "ray_elevation_angle"}, {"units", "degrees"}};
        case RadialFact::nyquist:
            return {{"units", speed_unit}};
    }
    return {};
}

ZarrArray array_of(std::string_view name, ZarrNumber number, std::vector<std::string> dimensions,
                   std::vector<std::size_t> shape, ZarrJson attributes = ZarrJson::object()) {
    ZarrArray array{.name = std::string(name),
                    .number = number,
                    .dimensions = std::move(dimensions),
                    .shape = shape,
                    .chunk = std::move(shape),
                    .fill = "NaN",
                    .packing = zarr::ZarrPacking::zstd,
                    .attributes = std::move(attributes)};
    for (std::size_t& side : array.chunk)
        side = std::max<std::size_t>(side, 1);
    if (number == ZarrNumber::int64) array.fill = no_time_ms;
    if (number == ZarrNumber::text) array.fill = "";
    return array;
}

// Cuts an array into chunks of one volume.
ZarrArray by_volume(ZarrArray array) {
    array.chunk.front() = 1;
    return array;
}

std::string states_name(std::string_view moment) {
    return std::string(moment) + std::string(status_ending);
}

void add_moment(ZarrGroup& group, const SweepPlace& place, const PlacedMoment& moment,
                std::size_t times) {
    const MomentNames names = fm301_names(moment.moment);
    ZarrJson attributes = ZarrJson::object();
    if (!names.standard_name.empty()) attributes["standard_name"] = names.standard_name;
    if (!names.long_name.empty()) attributes["long_name"] = names.long_name;
    attributes["units"] = names.unit;
    const std::vector<std::size_t> shape{times, place.azimuths(), place.axis_of(moment).gates};
    ZarrArray values = by_volume(array_of(names.name, ZarrNumber::float32,
                                          {"vcp_time", "azimuth", moment.axis}, shape, attributes));
    ZarrArray states = values;
    states.name = states_name(names.name);
    states.number = ZarrNumber::uint8;
    states.fill = static_cast<int>(level2::GateStatus::no_data);
    states.attributes = {{"long_name", "State of the gates of " + std::string(names.name)},
                         {"flag_values", {0, 1, 2, 3, 4}},
                         {"flag_meanings", "value below_threshold range_folded no_data ambiguous"}};
    group.arrays.push_back(std::move(values));
    group.arrays.push_back(std::move(states));
}

void add_axes(ZarrGroup& group, const SweepPlace& place, std::size_t times) {
    ZarrArray time = array_of("vcp_time", ZarrNumber::int64, {"vcp_time"}, {times},
                              {{"standard_name", "time"},
                               {"long_name", "Start of the volume"},
                               {"units", since_1970},
                               {"calendar", "proleptic_gregorian"}});
    time.chunk = {times_of_a_chunk};
    group.arrays.push_back(std::move(time));
    group.arrays.push_back(array_of("azimuth", ZarrNumber::float64, {"azimuth"}, {place.azimuths()},
                                    {{"standard_name", "ray_azimuth_angle"},
                                     {"units", "degrees"},
                                     {"axis", "radial_azimuth_coordinate"}}));
    for (const GateAxis& axis : place.axes)
        group.arrays.push_back(array_of(axis.name, ZarrNumber::float32, {axis.name}, {axis.gates},
                                        {{"units", "meters"},
                                         {"standard_name", "projection_range_coordinate"},
                                         {"axis", "radial_range_coordinate"},
                                         {"spacing_is_constant", "true"},
                                         {"meters_between_gates", axis.gate_spacing_m},
                                         {"meters_to_center_of_first_gate", axis.first_gate_m}}));
}

ZarrJson document_of(const ZarrGroup& group, ZarrJson below) {
    return {{"zarr_format", 3},
            {"node_type", "group"},
            {"attributes", group.attributes},
            {"consolidated_metadata",
             {{"kind", "inline"}, {"must_understand", false}, {"metadata", std::move(below)}}}};
}

// Returns an array of one text in the codec vlen-utf8: the number of texts, then size and bytes.
std::string text_chunk(std::string_view text) {
    return zarr::bytes_of<std::uint32_t>({1, static_cast<std::uint32_t>(text.size())}) +
           std::string(text);
}

}  // namespace

StationFacts station_facts_of(const level2::Volume& volume) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const auto antenna = level2::antenna_position(volume);
    if (!antenna) return {volume.station, unknown, unknown, unknown};
    return {volume.station, antenna->latitude_deg, antenna->longitude_deg, antenna->altitude_m};
}

ZarrGroup zarr_root_of(const StationFacts& facts) {
    ZarrGroup group;
    for (const auto& [name, unit] : {std::pair{"latitude", "degrees_north"},
                                     {"longitude", "degrees_east"},
                                     {"altitude", "meters"}})
        group.arrays.push_back(array_of(name, ZarrNumber::float64, {}, {},
                                        {{"units", unit}, {"standard_name", name}}));
    group.attributes = {{"Conventions", "ODIM_H5/V2_2, Cf/Radial-2.0"},
                        {"instrument_name", facts.station},
                        {"source", "Level II"},
                        {"coordinates", "latitude longitude altitude"}};
    return group;
}

ZarrGroup zarr_group_of(const SweepPlace& place, std::size_t times) {
    ZarrGroup group;
    for (const SweepText& text : sweep_texts)
        group.arrays.push_back(array_of(text.name, ZarrNumber::text, {}, {}));
    group.arrays.push_back(array_of("sweep_fixed_angle", ZarrNumber::float64, {}, {}));
    group.arrays.push_back(array_of("sweep_number", ZarrNumber::int64, {}, {}));
    for (const PlacedMoment& moment : place.moments)
        add_moment(group, place, moment, times);
    for (const RadialArray& array : radial_arrays) {
        const bool is_time = array.fact == RadialFact::time;
        group.arrays.push_back(by_volume(array_of(
            array.name, is_time ? ZarrNumber::int64 : ZarrNumber::float32, {"vcp_time", "azimuth"},
            {times, place.azimuths()}, attributes_of(array.fact))));
    }
    add_axes(group, place, times);
    return group;
}

ZarrJson zarr3_of(const ZarrTree& tree, std::string_view path) {
    const std::string below_path = path.empty() ? std::string{} : std::string(path) + "/";
    ZarrJson below = ZarrJson::object();
    const ZarrGroup* asked = nullptr;
    for (const auto& [group_path, group] : tree) {
        if (group_path == path) {
            asked = &group;
        } else if (!group_path.starts_with(below_path)) {
            continue;
        }
        std::string prefix;
        if (group_path != path) {
            const std::string name = group_path.substr(below_path.size());
            below[name] = document_of(group, ZarrJson::object());
            prefix = name + "/";
        }
        for (const ZarrArray& array : group.arrays)
            below[prefix + array.name] = zarr3_of(array);
    }
    return asked == nullptr ? ZarrJson{} : document_of(*asked, std::move(below));
}

std::optional<SweepArray> sweep_array_of(const SweepPlace& place, std::string_view name) {
    for (const PlacedMoment& moment : place.moments) {
        const std::string_view own = fm301_names(moment.moment).name;
        if (name == own) return SweepArray{.moment = &moment};
        if (name == states_name(own)) return SweepArray{.moment = &moment, .has_states = true};
    }
    const auto fact = std::ranges::find(radial_arrays, name, &RadialArray::name);
    if (fact == radial_arrays.end()) return std::nullopt;
    return SweepArray{.fact = fact->fact};
}

std::optional<std::string> chunk_of(const level2::Sweep& sweep, const SweepPlace& place,
                                    const SweepArray& array) {
    if (array.moment == nullptr) return radial_facts(sweep, place, array.fact);
    return array.has_states ? sweep_states(sweep, place, *array.moment)
                            : sweep_values(sweep, place, *array.moment);
}

std::string root_chunk(const StationFacts& facts, std::string_view name) {
    if (name == "latitude") return zarr::bytes_of<double>({facts.latitude_deg});
    return zarr::bytes_of<double>({name == "longitude" ? facts.longitude_deg : facts.altitude_m});
}

std::string place_chunk(const SweepPlace& place, std::size_t number, std::string_view name) {
    const auto text = std::ranges::find(sweep_texts, name, &SweepText::name);
    if (text != sweep_texts.end()) return text_chunk(text->text);
    if (name == "sweep_fixed_angle") return zarr::bytes_of<double>({place.fixed_angle_deg});
    if (name == "sweep_number")
        return zarr::bytes_of<std::int64_t>({static_cast<std::int64_t>(number)});
    if (name == "azimuth") return zarr::bytes_of(azimuths_of(place));
    std::vector<float> ranges;
    const auto axis = std::ranges::find(place.axes, name, &GateAxis::name);
    for (std::size_t gate = 0; axis != place.axes.end() && gate < axis->gates; ++gate)
        ranges.push_back(static_cast<float>(
            axis->first_gate_m + axis->gate_spacing_m * static_cast<std::int64_t>(gate)));
    ranges.resize(std::max<std::size_t>(ranges.size(), 1));
    return zarr::bytes_of(ranges);
}

}  // namespace stormcellar::web
