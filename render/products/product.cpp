#include "render/products/product.h"

#include <algorithm>
#include <cctype>

#include "render/shades.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

bool shows_heights_seen(Product product) {
    return product == Product::lowest_seen || product == Product::highest_seen;
}

// Values below the table's first class, 0, do not exist.
bool is_never_negative(Moment moment) {
    return moment == Moment::sw || moment == Moment::phi || moment == Moment::cfp;
}

}  // namespace

Result<FlatField> map_field(const grid::BrickView& view, const Scene& scene,
                            const std::vector<ColumnSummary>& columns, int threads) {
    switch (scene.product) {
        case Product::composite:
            return composite_field(view, columns);
        case Product::cappi:
            return cappi_field(view, scene.moment, scene.cappi_height_m, threads);
        case Product::echo_top:
            return echo_top_field(view, scene.echo_top_dbz, threads);
        case Product::vil:
            return vil_field(view, threads);
        case Product::lowest_seen:
            return lowest_seen_field(view, threads);
        case Product::highest_seen:
            return highest_seen_field(view, threads);
        case Product::volume:
        case Product::section:
            break;
    }
    return fail(ErrorCode::internal, "{} is no map", product_name(scene.product));
}

std::string moment_title(Moment moment) {
    switch (moment) {
        case Moment::ref:
            return "Reflectivity";
        case Moment::vel:
            return "Radial velocity";
        case Moment::sw:
            return "Spectrum width";
        case Moment::zdr:
            return "Differential reflectivity";
        case Moment::phi:
            return "Differential phase";
        case Moment::rho:
            return "Correlation coefficient";
        case Moment::cfp:
            return "Clutter filter power removed";
    }
    return std::string(level2::moment_name(moment));
}

std::string product_title(const Scene& scene) {
    std::string title = moment_title(scene.moment);
    switch (scene.product) {
        case Product::volume:
            return title + ", 3D volume";
        case Product::composite: {
            std::string lower = title;
            lower.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(title[0])));
            return "Composite " + lower + " (column maximum)";
        }
        case Product::cappi:
            return fmt::format("{} at {:g} km above sea level (CAPPI)", title,
                               scene.cappi_height_m / 1000);
        case Product::section:
            return title + ", vertical section";
        case Product::echo_top:
            return fmt::format("Echo tops, {:g} dBZ", scene.echo_top_dbz);
        case Product::vil:
            return "Vertically integrated liquid";
        case Product::lowest_seen:
            return "Lowest height seen";
        case Product::highest_seen:
            return "Highest height seen";
    }
    return title;
}

std::string bar_heading(const Scene& scene) {
    const std::string unit = unit_shown(scene);
    return unit.empty() ? std::string(level2::moment_name(scene.moment)) : unit;
}

std::string clear_text(const Scene& scene, std::string_view conjunction) {
    const ColourTable& table = colours_of(scene);
    const bool takes_all =
        table.bar_begin || (is_never_negative(scene.moment) && !(table.lowest() > 0));
    if (takes_all) return "no echo";
    const std::string unit = unit_shown(scene);
    return fmt::format("no echo {} < {:g}{}{}", conjunction, table.lowest(),
                       unit.empty() ? "" : " ", unit);
}

std::vector<LegendRow> product_legend(const Scene& scene) {
    std::vector<LegendRow> rows;
    if (scene.product == Product::echo_top) {
        rows.push_back({"dotted: at least", shades::page, false});
        rows.push_back(
            {fmt::format("no echo or < {:g} dBZ", scene.echo_top_dbz), shades::seen, false});
    } else if (!shows_heights_seen(scene.product)) {
        rows.push_back({clear_text(scene, "or"), shades::seen, false});
    }
    if (!shows_heights_seen(scene.product)) {
        rows.push_back({"range folded", colours_of(scene).range_folded, false});
    }
    rows.push_back({"not seen", shades::not_seen, true});
    return rows;
}

}  // namespace stormcellar::render
