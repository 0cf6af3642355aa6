#include "tests/cache/made_grids.h"

#include <array>
#include <limits>

#include <fmt/format.h>

namespace stormcellar::testing {
namespace {

// Returns a grid around KBGM in which no cell is seen.
grid::Grid blank_grid(int nx, int ny, int levels) {
    grid::Grid made;
    made.spec.center_latitude_deg = 42.2;
    made.spec.center_longitude_deg = -75.98;
    made.spec.nx = nx;
    made.spec.ny = ny;
    for (int level = 1; level <= levels; ++level)
        made.spec.levels_m.push_back(500.0 * level);
    made.sites = {{"KBGM", 42.19969, -75.98472, 519.1}};
    made.provenance.source_files = {"KBGM20050822_024414"};
    made.provenance.stations = {"KBGM"};
    made.provenance.method = "column-linear";
    made.provenance.beam_model = "4/3 earth";
    made.provenance.averaging = "dBZ";
    made.provenance.software_version = "test";
    made.values.assign(made.spec.cell_count(), 0.0F);
    made.status.assign(made.spec.cell_count(), grid::CellStatus::not_seen);
    return made;
}

grid::Grid dense(int stored) {
    grid::Grid made =
        blank_grid(grid::brick_edge * most_bricks, grid::brick_edge, grid::brick_edge);
    made.status.assign(made.spec.cell_count(), grid::CellStatus::no_echo);
    constexpr std::array<int, most_bricks> order = {0, 2, 4, 6, 1, 3, 5, 7};
    for (int i = 0; i < stored; ++i) {
        const int first = order.at(static_cast<std::size_t>(i)) * grid::brick_edge;
        for (int x = first; x < first + grid::brick_edge; ++x) {
            const std::size_t at = made.spec.index(x, x % 16, 3);
            made.status[at] = grid::CellStatus::value;
            made.values[at] = static_cast<float>(x % 50);
        }
    }
    return made;
}

struct Made {
    grid::Grid grid;
    grid::BrickGrid bricks;
    explicit Made(int stored)
        : grid(dense(stored)), bricks(grid::BrickGrid::from(grid, quantization())) {}
    static grid::Quantization quantization() {
        grid::Quantization quantization;
        quantization.code_bytes = 2;
        return quantization;
    }
};

const Made& made(int stored) {
    static const std::array<Made, most_bricks> all = {Made(1), Made(2), Made(3), Made(4),
                                                      Made(5), Made(6), Made(7), Made(8)};
    return all.at(static_cast<std::size_t>(stored) - 1);
}

}  // namespace

grid::Grid small_grid() {
    using grid::CellStatus;
    grid::Grid made = blank_grid(40, 24, 18);
    made.time = *parse_utc("2005-08-22T02:44:14.123Z", UtcTime{});
    made.start_time = made.time;
    made.end_time = made.time + std::chrono::minutes{5};
    made.provenance.effects = "frame: WGS84 table";
    made.provenance.predicted_error = "position 714 m";
    made.provenance.vcp = 21;
    made.provenance.partial = true;
    made.provenance.notes = {"a note"};
    made.provenance.radar_troubles = {"KBGM: standby, alarm 452", "KOKX: on auxiliary power"};
    made.provenance.left_out = {"north (KFWS KTLX): nothing since 2005-08-22T02:30:00Z"};
    made.provenance.provisional = true;
    made.provenance.revision = 3;
    made.provenance.parts = {{"KBGM", made.time, 0x123456789ABCDEF0, {0, 16, 40, 8}},
                             {"KOKX", made.time + std::chrono::minutes{5}, 7, {16, 0, 24, 24}}};
    made.provenance.recipe = 0xFEDCBA9876543210;
    made.provenance.sweeps = {{0.5, made.start_time, 12.25, 18.5},
                              {1.5, made.start_time + std::chrono::seconds{25}, 300, 0}};
    made.provenance.audit = {
        {0.48F, 0, 60e3F, 1000, 950, 400, 1.25F, -0.0625F},
        {0.48F, 240e3F, std::numeric_limits<float>::infinity(), 7, 0, 0, 0, 0},
    };
    for (int iy = 0; iy < made.spec.ny; ++iy) {
        for (int ix = 0; ix < made.spec.nx; ++ix) {
            for (int iz = 0; iz < made.spec.nz(); ++iz) {
                const std::size_t at = made.spec.index(ix, iy, iz);
                const bool stored_brick = ix < 16 && iy < 16 && iz < 16;
                if (stored_brick && (ix + iy + iz) % 3 == 0) {
                    made.status[at] = CellStatus::value;
                    made.values[at] = static_cast<float>(ix + iy) - 3.2F;
                } else if (stored_brick && (ix + iy + iz) % 3 == 1) {
                    made.status[at] = CellStatus::range_folded;
                } else if (ix < 32 && iz > 2) {
                    made.status[at] = CellStatus::no_echo;
                }
            }
        }
    }
    return made;
}

grid::Grid ambiguous_grid() {
    grid::Grid made = small_grid();
    made.moment = level2::Moment::veld;
    for (int iy = 0; iy < made.spec.ny; ++iy) {
        for (int ix = 0; ix < made.spec.nx; ++ix) {
            for (int iz = 0; iz < made.spec.nz(); ++iz) {
                grid::CellStatus& status = made.status[made.spec.index(ix, iy, iz)];
                const bool is_every_other = status == grid::CellStatus::range_folded && iy % 2 == 0;
                if (is_every_other || ix >= 32) status = grid::CellStatus::ambiguous;
            }
        }
    }
    return made;
}

const grid::BrickGrid& sized_grid(int stored) {
    return made(stored).bricks;
}

cache::GridDescription sized_description(UtcTime time, int number) {
    cache::GridDescription about = cache::describe(made(1).grid);
    about.time = about.start_time = about.end_time = time;
    about.provenance.notes = {std::to_string(number)};
    return about;
}

Result<std::filesystem::path> commit_sized(cache::StoreWriter& store, const std::string& domain,
                                           UtcTime time, int stored, int number) {
    return store.commit(domain, sized_description(time, number), sized_grid(stored).view());
}

std::vector<cache::StoreEntry> all_grids(const cache::StoreReader& store) {
    std::vector<cache::StoreEntry> all;
    for (const std::string& domain : store.domains().value_or(std::vector<std::string>{})) {
        const auto entries = store.list(domain, level2::Moment::ref, std::nullopt, std::nullopt);
        if (entries) all.insert(all.end(), entries->begin(), entries->end());
    }
    return all;
}

std::vector<std::string> short_names(const std::vector<cache::StoreEntry>& grids) {
    std::vector<std::string> names;
    for (const cache::StoreEntry& grid : grids) {
        const auto after_noon = std::chrono::floor<std::chrono::minutes>(grid.time - noon);
        names.push_back(fmt::format("{}{:+}", grid.domain, after_noon.count()));
    }
    return names;
}

std::string trouble_in(const cache::StoreEntry& entry) {
    const auto file = cache::GridFile::open(entry.path);
    if (!file) return file.error().message;
    if (const Status whole = file->verify(); !whole) return whole.error().message;
    if (file->description().time != entry.time) return "another time than its name's";
    const grid::Grid cells = grid::to_dense(file->view());
    for (int stored = 1; stored <= most_bricks; ++stored) {
        if (cells.status == made(stored).grid.status) return "";
    }
    return entry.path.native() + ": cells that nobody wrote";
}

}  // namespace stormcellar::testing
