#include "render/map/legend.h"

#include <fmt/format.h>

#include "render/products/ground.h"
#include "render/shades.h"

namespace stormcellar::render {
namespace {

// "no echo and < 5 dBZ"
std::string unseen_words(const ColourTable& table, std::string_view between) {
    return fmt::format("no echo {} < {:g}{}{}", between, table.lowest(),
                       table.unit.empty() ? "" : " ", table.unit);
}

}  // namespace

std::string_view moment_words(level2::Moment moment) {
    switch (moment) {
        case level2::Moment::ref:
            return "Reflectivity";
        case level2::Moment::vel:
            return "Radial velocity";
        case level2::Moment::sw:
            return "Spectrum width";
        case level2::Moment::zdr:
            return "Differential reflectivity";
        case level2::Moment::phi:
            return "Differential phase";
        case level2::Moment::rho:
            return "Correlation coefficient";
        case level2::Moment::cfp:
            return "Clutter filter power";
    }
    return level2::moment_name(moment);
}

Legend legend_of(const Scene& scene, level2::Moment moment, const ColourTable& table) {
    Legend legend;
    legend.table = &table;
    if (scene.product == Product::composite) {
        std::string words(moment_words(moment));
        words.front() = static_cast<char>(words.front() - 'A' + 'a');
        legend.product = fmt::format("Composite {} (column maximum)", words);
        legend.rows = {{unseen_words(table, "or"), shades::seen, false},
                       {"range folded", table.range_folded, false},
                       {"not seen", shades::not_seen, true}};
        return legend;
    }
    const std::string height = fmt::format("{:g} km", low_coverage_m / 1000);
    legend.product = fmt::format("{}, 3D volume", moment_words(moment));
    legend.heading = "Coverage (ground)";
    legend.rows = {{"seen below " + height, shades::seen, false},
                   {"seen above " + height, shades::seen_aloft, false},
                   {"not seen", shades::not_seen, true}};
    legend.notes = {unseen_words(table, "and"), "are clear"};
    return legend;
}

}  // namespace stormcellar::render
