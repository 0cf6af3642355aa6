#include "cli/storms/cells_input.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <utility>

#include "cli/picture/picture_grid.h"

namespace stormcellar::cli {
namespace {

constexpr std::string_view grid_file_ending = ".scg";  // stormcellar/cache/grid_name.h

// The grids of one time: reflectivity, and azimuthal shear if it was asked for.
using CellGrids = std::vector<PictureGrid>;

Result<CellGrids> grids_of_level2(const CellInput& input, std::vector<std::string> files) {
    GridOptions options = input.grid;
    options.files = std::move(files);
    options.takes_moments = true;
    options.moment = level2::moment_name(level2::Moment::ref);
    if (input.shear)
        options.moment += fmt::format(",{}", level2::moment_name(level2::Moment::azsh));
    return PictureGrid::make_each(std::move(options));
}

Result<CellGrids> grids_of(const CellInput& input, const std::string& file) {
    if (std::filesystem::path(file).extension() != grid_file_ending)
        return grids_of_level2(input, {file});
    if (input.shear) {
        return fail(ErrorCode::bad_argument,
                    "{}: --shear takes Level II files, because a grid of reflectivity has no "
                    "velocities",
                    file);
    }
    auto opened = PictureGrid::open(file);
    if (!opened) return pass_on(opened);
    if (opened->description().moment != level2::Moment::ref)
        return fail(ErrorCode::bad_argument, "{}: holds {}, and cells need reflectivity", file,
                    level2::moment_name(opened->description().moment));
    CellGrids grids;
    grids.push_back(std::move(*opened));
    return grids;
}

// Makes the grids of each file. If each file is of another radar, makes one mosaic of all.
Result<std::vector<CellGrids>> grids_of_files(const CellInput& input) {
    std::vector<CellGrids> all;
    std::set<std::string> areas;
    for (const std::string& file : input.grid.files) {
        auto grids = grids_of(input, file);
        if (!grids) return pass_on(grids);
        areas.insert(grids->front().name());
        all.push_back(std::move(*grids));
    }
    if (areas.size() == 1) return all;
    if (areas.size() < all.size()) {
        return fail(ErrorCode::bad_argument,
                    "cells take files of one radar, or one file of each of several radars");
    }
    all.clear();
    auto mosaic = grids_of_level2(input, input.grid.files);
    if (!mosaic) return pass_on(mosaic);
    all.push_back(std::move(*mosaic));
    return all;
}

Result<retrieve::CellScan> scan_of(const CellGrids& grids, const CellInput& input) {
    const PictureGrid& reflectivity = grids.front();
    retrieve::CellFields fields{reflectivity.view(), {}, input.freezing};
    if (grids.size() > 1) fields.azimuthal_shear = grids[1].view();
    auto scan = retrieve::find_cells(fields, reflectivity.description().time, reflectivity.name());
    if (!scan) return pass_on(scan);
    if (Status whole = reflectivity.check_whole(); !whole)
        return tl::unexpected(std::move(whole).error());
    return scan;
}

}  // namespace

Result<std::vector<retrieve::CellScan>> find_cell_scans(CellInput input) {
    if (auto inputs = find_inputs(input.grid); !inputs) return pass_on(inputs);
    auto grids = grids_of_files(input);
    if (!grids) return pass_on(grids);
    std::ranges::stable_sort(*grids, {},
                             [](const CellGrids& one) { return one.front().description().time; });
    std::vector<retrieve::CellScan> scans;
    for (std::size_t i = 0; i < grids->size(); ++i) {
        auto scan = scan_of((*grids)[i], input);
        if (!scan) return pass_on(scan);
        if (i > 0) {
            const grid::BrickView before = (*grids)[i - 1].front().view();
            const grid::BrickView after = (*grids)[i].front().view();
            const double seconds = seconds_between(scans.back().time, scan->time);
            if (seconds > 0 && *before.spec == *after.spec) {
                const Status guessed = retrieve::guess_motions(*scan, before, after, seconds);
                if (!guessed) return tl::unexpected(guessed.error());
            }
        }
        scans.push_back(std::move(*scan));
    }
    return scans;
}

}  // namespace stormcellar::cli
