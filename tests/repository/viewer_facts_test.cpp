// viewer/src/facts.ts has what the page must know as C++ knows it: moments, units, projections and
// the colors of the ground. It is made here, from the tables. After a change of a table write it
// with
//   STORMCELLAR_WRITE_FACTS=1 repository_test --gtest_filter='ViewerFacts.*'
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "render/image/shades.h"
#include "stormcellar/grid/grid_spec.h"
#include "stormcellar/level2/moment.h"
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

std::string moments() {
    std::string text = "export const moments = {\n";
    for (const level2::MomentFacts& facts : level2::moment_facts) {
        text += fmt::format("    {}: {{ unit: '{}', mixing: '{}' }},\n", facts.name, facts.units,
                            mixing_of(facts.circle));
    }
    return text + "} as const;\n";
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
        text += fmt::format("    {}: {},\n", facts.name, static_cast<int>(facts.projection));
    return text + "} as const;\n";
}

std::string color(render::Rgba8 color) {
    return fmt::format("[{}, {}, {}]", color[0], color[1], color[2]);
}
std::string color_with_alpha(render::Rgba8 color) {
    return fmt::format("[{}, {}, {}, {}]", color[0], color[1], color[2], color[3]);
}

std::string ground(const render::GroundShades& shades) {
    return fmt::format("seen: {}, seenAloft: {}, notSeen: {}, beyond: {}", color(shades.seen),
                       color(shades.seen_aloft), color(shades.not_seen), color(shades.beyond));
}

std::string colors() {
    const render::Shades& dark = render::shades::dark;
    std::string text = "export const dark = {\n";
    text += fmt::format("    page: {},\n    {},\n    water: {{ {} }},\n", color(dark.page),
                        ground(dark.land), ground(dark.water));
    text += fmt::format("    hatch: {},\n    haze: {},\n", color(dark.hatch), color(dark.haze));
    for (const auto& [name, line] :
         {std::pair{"ring", dark.ring}, std::pair{"county", dark.county},
          std::pair{"state", dark.state}, std::pair{"country", dark.country},
          std::pair{"coast", dark.coast}, std::pair{"border", dark.border}})
        text += fmt::format("    {}: {},\n", name, color_with_alpha(line));
    text += fmt::format("    text: {},\n    quietText: {},\n    halo: {},\n", color(dark.text),
                        color(dark.quiet_text), color_with_alpha(dark.halo));
    return text + "} as const;\n";
}

std::string facts() {
    return "// Facts that the page shares with the C++ source, written by "
           "tests/repository/viewer_facts_test.cpp: change\n"
           "// them there.\n\n"
           "// Moments with their stored units ('1' for a number without one), and how cells are "
           "mixed between their centers.\n" +
           moments() + "\n// Units by quantity, the usual one first.\nexport const units = {\n" +
           units_of("speed", &render::UnitFacts::of_speed) +
           units_of("distance", &render::UnitFacts::of_distance) +
           units_of("height", &render::UnitFacts::of_height) +
           "} as const;\n\n// Projections by their names in JSON, and their numbers in packed "
           "grids.\n" +
           projections() +
           "\n// Colors behind the echo, of the dark theme: red, green, blue and, for lines and "
           "the halo, "
           "alpha to 255.\n" +
           colors();
}

TEST(ViewerFacts, AreThoseOfTheTables) {
    const auto path = testing::source_directory() / "viewer" / "src" / "facts.ts";
    if (std::getenv("STORMCELLAR_WRITE_FACTS") != nullptr) std::ofstream(path) << facts();
    EXPECT_EQ(testing::text_of(path), facts());
}

}  // namespace
}  // namespace stormcellar
