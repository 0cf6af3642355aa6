#include "render/products/product.h"

#include <algorithm>
#include <cctype>

#include "render/image/shades.h"

namespace stormcellar::render {
namespace {

using level2::Moment;

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

}  // namespace stormcellar::render
