#include "cli/picture/cell_scans.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>
#include <utility>

#include "stormcellar/retrieve/vertical_liquid.h"

namespace stormcellar::cli {
namespace {

constexpr std::string_view grid_file_ending = ".scg";  // stormcellar/cache/grid_name.h

// The grids of one time: reflectivity, and azimuthal shear if it was asked for; and their files.
struct CellGrids {
    std::vector<PictureGrid> grids;
    std::vector<std::string> files;

    [[nodiscard]] const PictureGrid& reflectivity() const { return grids.front(); }
    [[nodiscard]] const PictureGrid* shear() const {
        return grids.size() > 1 ? &grids[1] : nullptr;
    }
    [[nodiscard]] UtcTime time() const { return reflectivity().description().time; }
};

Result<CellGrids> grids_of_level2(const CellInput& input, std::vector<std::string> files) {
    GridOptions options = input.grid;
    options.files = files;
    options.takes_moments = true;
    options.moment = level2::moment_name(level2::Moment::ref);
    if (input.shear)
        options.moment += fmt::format(",{}", level2::moment_name(level2::Moment::azsh));
    auto grids = PictureGrid::make_each(std::move(options));
    if (!grids) return pass_on(grids);
    return CellGrids{std::move(*grids), std::move(files)};
}

// `names` are the words of the command line for the file.
Result<CellGrids> cell_grids_of(const CellInput& input, const std::string& file,
                                std::vector<std::string> names) {
    if (std::filesystem::path(file).extension() != grid_file_ending)
        return grids_of_level2(input, std::move(names));
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
    grids.grids.push_back(std::move(*opened));
    grids.files = {file};
    return grids;
}

// Makes the grids of each file. If each file is of a different radar, makes one mosaic of all
// files. `typed` has the words of the command line. If there is only one file, all words belong to
// it, because they may name its chunks.
Result<std::vector<CellGrids>> cell_grids_of_files(const CellInput& input, const InputFiles& inputs,
                                                   const std::vector<std::string>& typed) {
    std::vector<CellGrids> all;
    std::set<std::string> areas;
    for (const std::string& file : input.grid.files) {
        const bool is_single = input.grid.files.size() == 1;
        auto grids = cell_grids_of(input, file, is_single ? typed : std::vector{file});
        if (!grids && inputs.is_found(file) && is_no_volume(grids.error())) {
            print_note("left out: " + grids.error().message);
            continue;
        }
        if (!grids) return pass_on(grids);
        areas.insert(grids->reflectivity().name());
        all.push_back(std::move(*grids));
    }
    if (areas.empty()) return fail(ErrorCode::not_found, "none of the files is a volume");
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

}  // namespace

Result<retrieve::CellScan> scan_grid(const PictureGrid& reflectivity, const PictureGrid* shear,
                                     const PictureGrid* before, const std::string& area,
                                     const std::optional<retrieve::FreezingLevels>& freezing) {
    retrieve::CellFields fields{
        .reflectivity = reflectivity.view(),
        .azimuthal_shear = std::nullopt,
        .freezing = freezing,
        .radar_m = retrieve::mean_radar_height_m(reflectivity.description().sites)};
    if (shear != nullptr) fields.azimuthal_shear = shear->view();
    auto scan = retrieve::find_cells(fields, reflectivity.description().time, area);
    if (!scan) return scan;
    if (before != nullptr) {
        const grid::BrickView earlier = before->view();
        const double seconds = seconds_between(before->description().time, scan->time);
        if (seconds > 0 && *earlier.spec == *fields.reflectivity.spec) {
            const Status guessed =
                retrieve::guess_motions(*scan, earlier, fields.reflectivity, seconds);
            if (!guessed) return pass_on(guessed);
        }
        if (Status whole = before->check_whole(); !whole) return pass_on(whole);
    }
    if (Status whole = reflectivity.check_whole(); !whole) return pass_on(whole);
    return scan;
}

namespace {

// Makes the grids of the files that the input names, in the order of their times.
Result<std::vector<CellGrids>> cell_grids_by_time(CellInput input) {
    const std::vector<std::string> typed = input.grid.files;
    std::vector<CellGrids> grids;
    if (typed == std::vector<std::string>{"-"}) {
        // Standard input can be read only once.
        auto made = grids_of_level2(input, typed);
        if (!made) return pass_on(made);
        grids.push_back(std::move(*made));
        return grids;
    }
    const auto inputs = find_inputs(input.grid);
    if (!inputs) return pass_on(inputs);
    auto made = cell_grids_of_files(input, **inputs, typed);
    if (made) std::ranges::stable_sort(*made, {}, &CellGrids::time);
    return made;
}

}  // namespace

Result<CellScans> find_cell_scans(CellInput input) {
    const auto freezing = input.freezing;
    auto grids = cell_grids_by_time(std::move(input));
    if (!grids) return pass_on(grids);
    std::vector<retrieve::CellScan> scans;
    for (std::size_t i = 0; i < grids->size(); ++i) {
        const CellGrids& one = (*grids)[i];
        const PictureGrid* const before = i > 0 ? &(*grids)[i - 1].reflectivity() : nullptr;
        auto scan =
            scan_grid(one.reflectivity(), one.shear(), before, one.reflectivity().name(), freezing);
        if (!scan) return pass_on(scan);
        scans.push_back(std::move(*scan));
    }
    CellGrids& newest = grids->back();
    return CellScans{std::move(scans), std::move(newest.grids.front()), std::move(newest.files)};
}

Result<render::CellOverlay> overlay_of(std::span<const retrieve::CellScan> scans) {
    auto tracked = retrieve::track_cells(scans);
    if (!tracked) return pass_on(tracked);
    render::CellOverlay overlay;
    overlay.volumes = tracked->size();
    overlay.scan = std::move(tracked->back());
    return overlay;
}

}  // namespace stormcellar::cli
