// Makes small grid files with every kind of brick, both sizes of codes and every projection.
#include <filesystem>
#include <stdexcept>

#include <unistd.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_grid.h"
#include "tests/fuzz/seeds.h"

namespace stormcellar::fuzz {
namespace {

namespace fs = std::filesystem;

// Returns a grid of two bricks, one above the other. The lower brick has codes; the upper brick has
// several states, or only one state.
grid::Grid two_bricks(bool mixed_above) {
    using grid::CellStatus;
    grid::Grid made;
    made.spec = grid::default_spec(42.2, -75.98);
    made.spec.nx = 12;
    made.spec.ny = 9;
    made.spec.levels_m.clear();
    for (int level = 1; level <= 20; ++level)
        made.spec.levels_m.push_back(500.0 * level);
    made.time = *parse_utc("2005-08-22T02:44:14.123Z", UtcTime{});
    made.start_time = made.end_time = made.time;
    made.sites = {{"KBGM", 42.19969, -75.98472, 519.1}};
    made.provenance.source_files = {"KBGM20050822_024414.gz"};
    made.provenance.stations = {"KBGM"};
    made.provenance.method = "column-linear";
    made.provenance.notes = {"a note"};
    made.values.assign(made.spec.cell_count(), 0.0F);
    made.status.assign(made.spec.cell_count(), CellStatus::no_echo);
    for (int ix = 0; ix < made.spec.nx; ++ix) {
        for (int iz = 0; iz < made.spec.nz(); ++iz) {
            const std::size_t at = made.spec.index(ix, ix % made.spec.ny, iz);
            if (iz < 16) {
                made.status[at] = iz % 3 == 0 ? CellStatus::range_folded : CellStatus::value;
                made.values[at] = static_cast<float>(5 * ix - iz);
            } else if (mixed_above) {
                made.status[at] = CellStatus::not_seen;
            }
        }
    }
    return made;
}

level2::wire::Bytes bytes_of(const grid::Grid& grid, int code_bytes,
                             cache::Packing packing = cache::Packing::none) {
    const fs::path path =
        fs::temp_directory_path() / ("stormcellar-seed-" + std::to_string(::getpid()) + ".scg");
    grid::Quantization quantization{.code_bytes = code_bytes};
    const auto bricks = grid::BrickGrid::from(grid, quantization);
    const auto written = cache::write_grid_file(real_file_system(), path, cache::describe(grid),
                                                bricks.view(), packing);
    if (!written) throw std::runtime_error(written.error().message);
    auto bytes = read_file(path);
    fs::remove(path);
    if (!bytes) throw std::runtime_error(bytes.error().message);
    return std::move(*bytes);
}

}  // namespace

std::vector<Seed> grid_file_seeds() {
    grid::Grid degrees = two_bricks(false);
    degrees.spec.projection = grid::Projection::latitude_longitude;
    degrees.spec.spacing_m = 0;
    degrees.spec.spacing_deg = 0.0123;
    grid::Grid conformal = two_bricks(false);
    conformal.spec.projection = grid::Projection::lambert_conformal;
    conformal.spec.parallels_deg = {33, 45.5};
    level2::wire::Bytes altered = bytes_of(two_bricks(true), 1);
    altered.back() = std::byte{1};  // where no brick is stored
    level2::wire::Bytes cut = bytes_of(two_bricks(true), 1);
    cut.resize(cut.size() - 4096);
    return {
        {"states", bytes_of(two_bricks(true), 1)},
        {"uniform", bytes_of(two_bricks(false), 1)},
        {"two_byte_codes", bytes_of(two_bricks(true), 2)},
        {"degrees", bytes_of(degrees, 1)},
        {"conformal", bytes_of(conformal, 1)},
        {"packed", bytes_of(two_bricks(true), 1, cache::Packing::lz4)},
        {"packed_two_byte_codes", bytes_of(two_bricks(true), 2, cache::Packing::lz4)},
        {"altered", altered},
        {"cut", cut},
    };
}

}  // namespace stormcellar::fuzz
