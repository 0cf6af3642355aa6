// Tests that viewer/src/facts.ts has the facts of the C++ tables that the page needs: moments,
// units, projections, the usual grid, ranges of options, color files, the colors of the ground,
// kinds of lines of the map and the colors of warnings.
// After a change of a table, write the file with
//   STORMCELLAR_WRITE_FACTS=1 repository_test --gtest_filter='ViewerFacts.*'
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "render/color/color_file.h"
#include "render/color/moment_look.h"
#include "render/color/pal_words.h"
#include "render/image/shades.h"
#include "render/map/base_map.h"
#include "render/overlay/event_colors.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/moment.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/scene.h"
#include "stormcellar/render/units.h"
#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

std::string_view mixing_of(level2::Circle circle) {
    switch (circle) {
        case level2::Circle::none:
            return "mean";
        case level2::Circle::nyquist:
            return "heaviest";  // a grid does not hold the Nyquist velocity
        case level2::Circle::full_turn:
            return "circle";
    }
    return {};
}

// Returns the facts of a moment, without those that viewer/src/wire/moments.ts calls usual.
std::string moment_row(const level2::MomentFacts& facts) {
    std::vector<std::string> known = {fmt::format("unit: '{}'", facts.units)};
    const auto add = [&](bool is_unusual, std::string_view name, std::string_view value) {
        if (is_unusual) known.push_back(fmt::format("{}: {}", name, value));
    };
    const auto quoted = [](std::string_view word) { return fmt::format("'{}'", word); };
    const level2::Moment measured = level2::measured_moment(facts.moment);
    const level2::Moment tables = render::table_moment(facts.moment);
    add(facts.circle != level2::Circle::none, "mixing", quoted(mixing_of(facts.circle)));
    add(facts.is_signed, "isSigned", "true");
    add(facts.is_doppler, "isDoppler", "true");
    add(facts.is_derived, "isDerived", "true");
    add(measured != facts.moment, "measured", quoted(level2::moment_name(measured)));
    add(tables != facts.moment, "tables", quoted(level2::moment_name(tables)));
    return fmt::format("    {}: {{ {} }},\n", facts.name, fmt::join(known, ", "));
}

std::string moments() {
    std::string text = "export const moments = {\n";
    std::string titles = "export const momentTitles = {\n";
    for (const level2::MomentFacts& facts : level2::moment_facts) {
        text += moment_row(facts);
        titles += fmt::format("    {}: '{}',\n", facts.name, render::look_of(facts.moment).title);
    }
    return text + "} as const;\n" + titles + "} as const;\n";
}

std::string units_of(std::string_view quantity, bool render::UnitFacts::*is_of) {
    std::string text = fmt::format("    {}: [\n", quantity);
    for (const render::UnitFacts& facts : render::all_units()) {
        if (!(facts.*is_of)) continue;
        text += fmt::format("        {{ name: '{}', symbol: '{}', si: {} }},\n", facts.name,
                            facts.symbol, facts.si);
    }
    return text + "    ],\n";
}

std::string projections() {
    std::string text = "export const projections = {\n";
    for (const grid::ProjectionFacts& facts : grid::projection_facts)
        text += fmt::format("    {}: {{ number: {}, isInDegrees: {} }},\n", facts.name,
                            static_cast<int>(facts.projection), facts.in_degrees);
    return text + "} as const;\n";
}

std::string usual_grid() {
    const grid::GridSpec spec = grid::default_spec(0, 0);
    return fmt::format(
        "export const usualGrid = {{ nx: {}, ny: {}, spacingM: {}, levels: {}, betweenLevelsM: {} "
        "}} as const;\n",
        spec.nx, spec.ny, spec.spacing_m, spec.nz(), spec.levels_m.front());
}

std::string ranges() {
    namespace limits = render::limits;
    std::string text = "export const ranges = {\n";
    for (const auto& [name, range] :
         {std::pair{"sidePx", limits::side_px}, std::pair{"tiltDeg", limits::tilt_deg},
          std::pair{"zoom", limits::zoom}, std::pair{"fieldOfViewDeg", limits::field_of_view_deg},
          std::pair{"sectionKm", limits::section_km}, std::pair{"planeM", limits::cappi_height_m},
          std::pair{"exaggeration", limits::exaggeration}, std::pair{"opacity", limits::opacity}})
        text += fmt::format("    {}: {{ least: {}, most: {} }},\n", name, range.least, range.most);
    return text + "} as const;\n";
}

std::string quoted_if_needed(std::string_view key) {
    const bool is_plain = key.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == key.npos;
    return is_plain ? std::string(key) : fmt::format("'{}'", key);
}

std::string pal_words() {
    std::string text =
        "export const palProducts: Record<string, { moment?: string; unit: string }> = {\n";
    for (const render::PalProduct& product : render::pal_products) {
        const std::string moment =
            product.moment ? fmt::format("moment: '{}', ", level2::moment_name(*product.moment))
                           : "";
        text += fmt::format(
            "    {}: {{ {}unit: '{}' }},\n", product.word, moment,
            product.moment ? render::unit_of(*product.moment) : std::string(product.unit));
    }
    text += "};\nexport const palUnits: Record<string, [number, string]> = {\n";
    for (const render::PalUnit& unit : render::pal_units)
        text += fmt::format("    {}: [{}, '{}'],\n", quoted_if_needed(unit.word), unit.per_ours,
                            unit.ours);
    return text + "};\n";
}

std::string color(render::Rgba8 color) {
    return fmt::format("[{}, {}, {}]", color[0], color[1], color[2]);
}
std::string color_with_alpha(render::Rgba8 color) {
    return fmt::format("[{}, {}, {}, {}]", color[0], color[1], color[2], color[3]);
}

std::string ground(const render::GroundShades& shades, std::string_view between) {
    return fmt::format("seen: {}{between}seenAloft: {}{between}notSeen: {}{between}beyond: {}",
                       color(shades.seen), color(shades.seen_aloft), color(shades.not_seen),
                       color(shades.beyond), fmt::arg("between", between));
}

std::string colors() {
    const render::Shades& dark = render::shades::dark;
    std::string text = "export const dark = {\n";
    text += fmt::format("    page: {},\n    {},\n    water: {{ {} }},\n", color(dark.page),
                        ground(dark.land, ",\n    "), ground(dark.water, ", "));
    text += fmt::format("    hatch: {},\n    haze: {},\n", color(dark.hatch), color(dark.haze));
    for (const auto& [name, line] :
         {std::pair{"ring", dark.ring}, std::pair{"county", dark.county},
          std::pair{"state", dark.state}, std::pair{"country", dark.country},
          std::pair{"coast", dark.coast}, std::pair{"interstate", dark.interstate},
          std::pair{"highway", dark.highway}, std::pair{"border", dark.border}})
        text += fmt::format("    {}: {},\n", name, color_with_alpha(line));
    text += fmt::format("    text: {},\n    quietText: {},\n    halo: {},\n", color(dark.text),
                        color(dark.quiet_text), color_with_alpha(dark.halo));
    return text + "} as const;\n";
}

std::string map_kinds() {
    std::string text = "export const mapKinds = {\n";
    for (const render::MapKindFacts& known : render::map_kinds)
        text += fmt::format("    {}: {{ usualM: {}, leastPixels: {} }},\n", known.name,
                            known.usual_m, known.least_px);
    return text + "} as const;\n";
}

std::string event_colors() {
    std::string text = "export const eventColors = [\n";
    for (const render::EventColor& known : render::event_colors)
        text += fmt::format("    {{ event: '{}', color: {} }},\n", known.event, color(known.color));
    return text + "] as const;\n";
}

std::string color_files() {
    return fmt::format(
        "export const colorFiles = {{\n    mostBytes: {},\n    mostStops: {},\n"
        "    greatestValue: {},\n    rangeFolded: {},\n    clearAir: '{}',\n}} as const;\n",
        render::most_color_file_bytes, render::most_stops, render::greatest_color_value,
        color_with_alpha(render::usual_range_folded), render::clear_air_colors().name);
}

std::string facts() {
    return "// Facts that the page shares with the C++ source, written by "
           "tests/repository/viewer_facts_test.cpp: change\n"
           "// them there.\n\n"
           "// Moments in the order of their numbers in packed grids and sweeps, with their stored "
           "units ('1' for a number\n// without one), and how cells are mixed between their "
           "centers.\n" +
           moments() + "\n// Units by quantity, the usual one first.\nexport const units = {\n" +
           units_of("speed", &render::UnitFacts::of_speed) +
           units_of("distance", &render::UnitFacts::of_distance) +
           units_of("height", &render::UnitFacts::of_height) +
           "} as const;\n\n// Projections by their names in JSON, with their numbers in packed "
           "grids. "
           "Cells are regular in degrees or meters.\n" +
           projections() + "\n// The grid that `stormcellar frame` makes of a raw file.\n" +
           usual_grid() +
           "\n// Ranges of numbers that pictures take. A field of view may be 0, too.\n" +
           ranges() +
           "\n// Limits of files of color tables, the color of range folded air where a file has "
           "none, and "
           "the table of clear air.\n" +
           color_files() +
           "\n// Products of .pal files with moment and unit of their values; their units, as how "
           "many make "
           "one of ours.\n" +
           pal_words() +
           "\n// Colors behind the echo, of the dark theme: red, green, blue and, for lines and "
           "the halo, "
           "alpha to 255.\n" +
           colors() +
           "\n// Kinds of lines of the map in the order in which they are drawn. Lines are shown "
           "only "
           "where the usual distance\n// between them is at least so many pixels.\n" +
           map_kinds() +
           "\n// Colors of events in the map of hazards of the National Weather Service.\n" +
           event_colors();
}

TEST(ViewerFacts, AreThoseOfTheTables) {
    const auto path = testing::source_directory() / "viewer" / "src" / "facts.ts";
    if (std::getenv("STORMCELLAR_WRITE_FACTS") != nullptr) std::ofstream(path) << facts();
    EXPECT_EQ(testing::text_of(path), facts());
}

}  // namespace
}  // namespace stormcellar
