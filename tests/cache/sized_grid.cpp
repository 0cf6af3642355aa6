#include "tests/cache/sized_grid.h"

#include <array>

namespace stormcellar::testing {
namespace {

grid::Grid dense(int stored) {
    grid::Grid made;
    made.spec.center_latitude_deg = 42.2;
    made.spec.center_longitude_deg = -75.98;
    made.spec.nx = grid::brick_edge * most_bricks;
    made.spec.ny = grid::brick_edge;
    for (int level = 1; level <= grid::brick_edge; ++level)
        made.spec.levels_m.push_back(500.0 * level);
    made.sites = {{"KBGM", 42.19969, -75.98472, 519.1}};
    made.provenance.source_files = {"KBGM20050822_024414.gz"};
    made.provenance.stations = {"KBGM"};
    made.provenance.method = "column-linear";
    made.provenance.beam_model = "4/3 earth";
    made.provenance.averaging = "dBZ";
    made.provenance.software_version = "test";
    made.values.assign(made.spec.cell_count(), 0.0F);
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
