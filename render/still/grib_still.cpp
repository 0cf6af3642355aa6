// Writes GRIB2: the values of a map in the units of WMO's tables, and the states of its columns. A
// cell is a column of the grid, so nothing is resampled.
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "export/grib_map.h"
#include "render/still/map_attributes.h"
#include "render/still/map_raster.h"
#include "render/still/still_format.h"
#include "stormcellar/render/product.h"

namespace stormcellar::render {
namespace {

constexpr int entire_atmosphere = 10, ground = 1, above_sea_level = 102;

// A product of a moment, and its place in WMO's code table 4.2.
struct GribRow {
    Product product = Product::composite;
    level2::Moment moment = level2::Moment::ref;
    int category = 0, number = 0;  // of discipline 0, meteorological products
    int surface = 0;
    double factor = 1;  // from the product's unit to the table's
};
constexpr double per_second = 1.0 / 3600;
constexpr std::array grib_rows{
    GribRow{Product::composite, level2::Moment::ref, 16, 5, entire_atmosphere},       // dB
    GribRow{Product::cappi, level2::Moment::ref, 16, 4, above_sea_level},             // dB
    GribRow{Product::echo_top, level2::Moment::ref, 16, 3, entire_atmosphere, 1000},  // m
    GribRow{Product::vil, level2::Moment::ref, 15, 3, entire_atmosphere},             // kg m-2
    GribRow{Product::mesh, level2::Moment::ref, 1, 31, ground, 0.001},                // m, of hail
    GribRow{Product::rain_total, level2::Moment::rate, 1, 8, ground},                 // kg m-2
    // kg m-2 s-1; a millimeter of rain is a kilogram
    GribRow{Product::cappi, level2::Moment::rate, 1, 52, above_sea_level, per_second},
    GribRow{Product::composite, level2::Moment::rate, 1, 52, entire_atmosphere, per_second},
};

Result<GribRow> row_of(const Scene& scene) {
    std::vector<std::string> known;
    for (const GribRow& row : grib_rows) {
        const bool is_of_any = facts_of(row.product).only_moment.has_value();
        if (row.product == scene.product && (is_of_any || row.moment == scene.moment)) return row;
        known.push_back(is_of_any ? std::string(product_name(row.product))
                                  : fmt::format("{} of {}", product_name(row.product),
                                                level2::moment_name(row.moment)));
    }
    return fail(ErrorCode::unsupported, "GRIB2 has no number for {} of {}; it has {}",
                product_name(scene.product), level2::moment_name(scene.moment),
                fmt::join(known, ", "));
}

void add_notes(const netcdf::CfAttributes& attributes,
               std::vector<std::pair<std::string, std::string>>& notes) {
    for (const auto& [name, value] : attributes) {
        if (const auto* text = std::get_if<std::string>(&value)) notes.emplace_back(name, *text);
        if (const auto* number = std::get_if<double>(&value))
            notes.emplace_back(name, fmt::format("{}", *number));
    }
}

}  // namespace

Result<std::vector<std::byte>> encode_grib(const StillMap& map, const StillOptions& options) {
    const auto field = still_field(map, options.threads);
    if (!field) return pass_on(field);
    const auto row = row_of(map.scene);
    if (!row) return pass_on(row);
    std::vector<float> values = field->values;
    std::vector<std::uint8_t> states;
    for (std::size_t place = 0; place < values.size(); ++place) {
        values[place] = field->status[place] == grid::CellStatus::value
                            ? static_cast<float>(values[place] * row->factor)
                            : std::nanf("");
        states.push_back(state_of(*field, place));
    }
    grib::Parameter parameter{
        .discipline = 0, .category = row->category, .number = row->number, .surface = row->surface};
    if (row->surface == above_sea_level) parameter.height_m = map.scene.cappi_height_m;
    std::vector<std::pair<std::string, std::string>> notes;
    add_notes(map_file_attributes(map, options), notes);
    // The units are those of WMO's table.
    netcdf::CfAttributes attributes = map_attributes(map.scene, map.facts);
    std::erase_if(attributes, [](const auto& attribute) { return attribute.first == "units"; });
    add_notes(attributes, notes);
    std::vector<std::string> words;
    for (const StateClass& state : state_classes(map.scene.moment)) {
        if (may_have(map.scene.product, state))
            words.push_back(fmt::format("{} {}", state.code, state_word(state)));
    }
    notes.emplace_back("status", fmt::format("{}", fmt::join(words, ", ")));
    return grib::map_bytes({.spec = *map.view.spec,
                            .parameter = parameter,
                            .time = map.facts.time,
                            .since = map.facts.since,
                            .values = values,
                            .states = states,
                            .notes = std::move(notes)});
}

}  // namespace stormcellar::render
