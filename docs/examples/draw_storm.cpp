// Grids a Level II file in memory, prints the column of the strongest echo, and draws the storms in
// 3D.
#include <cstdio>
#include <filesystem>

#include <stormcellar/base/file_system.h>
#include <stormcellar/grid/brick_grid.h>
#include <stormcellar/grid/column_geometry.h>
#include <stormcellar/grid/gridder.h>
#include <stormcellar/level2/decode.h>
#include <stormcellar/render/png_file.h>
#include <stormcellar/render/render.h>

using namespace stormcellar;

namespace {

Result<grid::Grid> grid_file(const char* path) {
    const auto decoded = level2::decode_file(path);
    if (!decoded) return tl::unexpected(decoded.error());
    const auto antenna = level2::antenna_position(decoded->volume);
    if (!antenna) return tl::unexpected(Error{ErrorCode::not_found, "the site is not known"});
    const grid::SitePosition site{decoded->volume.station, antenna->latitude_deg,
                                  antenna->longitude_deg, antenna->altitude_m};
    // Make 460 x 460 x 32 cells of 1 km about the site. The spec describes all cells.
    const auto spec = grid::default_spec(site.latitude_deg, site.longitude_deg);
    // The geometry depends on site and spec. Keep it for the next volume.
    const auto geometry = grid::make_column_geometry(site, spec);
    if (!geometry) return tl::unexpected(geometry.error());
    return grid::make_grid(decoded->volume, site, **geometry, grid::GridderOptions{});
}

struct Column {
    int ix = 0, iy = 0;
};

// Every cell has one of four states. Only cells in the state `value` have a value.
Column strongest_column(const grid::Grid& grid) {
    Column strongest;
    float greatest_dbz = -100;
    for (int iz = 0; iz < grid.spec.nz(); ++iz) {
        for (int iy = 0; iy < grid.spec.ny; ++iy) {
            for (int ix = 0; ix < grid.spec.nx; ++ix) {
                const std::size_t cell = grid.spec.index(ix, iy, iz);
                if (grid.status[cell] != grid::CellStatus::value) continue;
                if (grid.values[cell] <= greatest_dbz) continue;
                greatest_dbz = grid.values[cell];
                strongest = {ix, iy};
            }
        }
    }
    return strongest;
}

void print_column(const grid::BrickView& view, Column column) {
    for (int iz = 0; iz < view.spec->nz(); ++iz) {
        const grid::CellStatus status = view.status(column.ix, column.iy, iz);
        const double height_km = view.spec->levels_m[static_cast<std::size_t>(iz)] / 1000;
        if (status == grid::CellStatus::value) {
            std::printf("%5.1f km  %5.1f dBZ\n", height_km, view.value(column.ix, column.iy, iz));
        } else {
            std::printf("%5.1f km  %s\n", height_km,
                        std::string(grid::cell_status_name(status)).c_str());
        }
    }
}

Status draw(const grid::Grid& grid, const grid::BrickView& view, const char* output) {
    render::Scene scene;  // a volume, from the south; the members say what else there is
    scene.width = 1280;
    scene.height = 800;
    const render::FrameFacts facts{grid.sites.front().icao, grid.moment, grid.time, grid.sites,
                                   grid.provenance.partial};
    const auto image = render::render_frame(view, facts, scene, 1);
    if (!image) return tl::unexpected(image.error());
    const auto png = render::encode_png(*image);
    if (!png) return tl::unexpected(png.error());
    return write_file_atomically(real_file_system(), output, *png);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: draw_storm FILE OUT.png\n");
        return 2;
    }
    const auto grid = grid_file(argv[1]);
    if (!grid) {
        std::fprintf(stderr, "%s\n", grid.error().message.c_str());
        return 1;
    }
    // Pictures and grid files need the cells as codes in bricks.
    const auto bricks =
        grid::BrickGrid::from(*grid, grid::default_quantization(level2::Moment::ref));
    print_column(bricks.view(), strongest_column(*grid));
    if (const Status drawn = draw(*grid, bricks.view(), argv[2]); !drawn) {
        std::fprintf(stderr, "%s\n", drawn.error().message.c_str());
        return 1;
    }
    return 0;
}
