// The module stormcellar_vdb.so: makes an OpenVDB file of grids (export/grid_vdb.h).
#include <algorithm>
#include <cstdint>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include "base/checksum.h"
#include "export/grid_fields.h"
#include "export/grid_vdb.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::vdb {
namespace {

using grid::CellStatus;

constexpr int leaf_side = openvdb::FloatTree::LeafNodeType::DIM;

// Writes a file with the offsets of its grids, so that readers can take one grid of it.
class SeekableArchive : public openvdb::io::Archive {
  public:
    void write_all(std::ostream& stream, const openvdb::GridCPtrVec& grids) const {
        constexpr bool seekable = true;
        write(stream, grids, seekable);
    }
};

float background_of(level2::Moment moment) {
    constexpr float no_echo_dbz = -33;
    return moment == level2::Moment::ref ? no_echo_dbz : 0;
}

openvdb::math::Transform::Ptr transform_of(const grid::GridSpec& spec) {
    const std::vector<double>& levels_m = spec.levels_m;
    const double step_m = levels_m.size() > 1 ? levels_m[1] - levels_m[0] : spec.cell_width_m();
    auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    transform->postScale(openvdb::Vec3d(spec.cell_width_m(), spec.cell_height_m(), step_m));
    transform->postTranslate(openvdb::Vec3d(spec.x_m(0), spec.y_m(0), levels_m.front()));
    return transform;
}

void add_attributes(const netcdf::CfAttributes& attributes, openvdb::MetaMap& to) {
    for (const auto& [name, value] : attributes) {
        if (const auto* text = std::get_if<std::string>(&value)) {
            to.insertMeta(name, openvdb::StringMetadata(*text));
        } else if (const auto* number = std::get_if<double>(&value)) {
            to.insertMeta(name, openvdb::DoubleMetadata(*number));
        } else if (const auto* count = std::get_if<int>(&value)) {
            to.insertMeta(name, openvdb::Int32Metadata(*count));
        } else {
            const auto& numbers = std::get<std::vector<double>>(value);
            to.insertMeta(name,
                          openvdb::StringMetadata(fmt::format("{}", fmt::join(numbers, " "))));
        }
    }
}

// Completes a grid: name, place and metadata.
void describe(openvdb::GridBase& to, std::string_view name, const grid::Grid& grid) {
    const grid::GridSpec& spec = grid.spec;
    to.setName(std::string(name));
    to.setTransform(transform_of(spec));
    netcdf::CfAttributes attributes = netcdf::provenance_attributes(std::span(&grid, 1));
    attributes.emplace_back("moment", std::string(level2::moment_name(grid.moment)));
    attributes.emplace_back("units", std::string(level2::moment_units(grid.moment)));
    attributes.emplace_back("time", format_utc(grid.frame_time.value_or(grid.time)));
    attributes.emplace_back("center_latitude_deg", spec.center_latitude_deg);
    attributes.emplace_back("center_longitude_deg", spec.center_longitude_deg);
    attributes.emplace_back("projection", netcdf::well_known_text(spec));
    add_attributes(attributes, to);
}

// A box of cells, in columns, rows and levels.
struct Block {
    int x, y, z, end_x, end_y, end_z;
};
Block all_cells(const grid::GridSpec& spec) {
    return {0, 0, 0, spec.nx, spec.ny, spec.nz()};
}

// Calls cell(coordinates, index) for each cell of a block.
template <class Cell>
void for_each_cell(const grid::GridSpec& spec, const Block& block, const Cell& cell) {
    for (int iy = block.y; iy < block.end_y; ++iy)
        for (int ix = block.x; ix < block.end_x; ++ix)
            for (int iz = block.z; iz < block.end_z; ++iz)
                cell(openvdb::Coord(ix, iy, iz), spec.index(ix, iy, iz));
}

// Calls take(block) for the part of each leaf of OpenVDB's tree that is in the grid.
template <class Take>
void for_each_leaf(const grid::GridSpec& spec, const Take& take) {
    for (int y = 0; y < spec.ny; y += leaf_side)
        for (int x = 0; x < spec.nx; x += leaf_side)
            for (int z = 0; z < spec.nz(); z += leaf_side)
                take(Block{x, y, z, std::min(x + leaf_side, spec.nx),
                           std::min(y + leaf_side, spec.ny), std::min(z + leaf_side, spec.nz())});
}

openvdb::GridBase::Ptr values_of(const grid::Grid& grid) {
    auto made = openvdb::FloatGrid::create(background_of(grid.moment));
    openvdb::FloatGrid::Accessor voxels = made->getAccessor();
    for_each_cell(grid.spec, all_cells(grid.spec), [&](const openvdb::Coord& at, std::size_t cell) {
        if (grid.status[cell] == CellStatus::value) voxels.setValue(at, grid.values[cell]);
    });
    describe(*made, level2::moment_name(grid.moment), grid);
    return made;
}

openvdb::GridBase::Ptr states_of(const grid::Grid& grid) {
    auto made = openvdb::FloatGrid::create(static_cast<float>(CellStatus::not_seen));
    openvdb::FloatGrid::Accessor voxels = made->getAccessor();
    // A leaf whose cells all have one state becomes a tile at once, because leaves of all states
    // would need as much memory as the values.
    for_each_leaf(grid.spec, [&](const Block& leaf) {
        const CellStatus first = grid.status[grid.spec.index(leaf.x, leaf.y, leaf.z)];
        std::size_t equal = 0;
        for_each_cell(grid.spec, leaf, [&](const openvdb::Coord&, std::size_t cell) {
            equal += grid.status[cell] == first ? 1 : 0;
        });
        if (equal == std::size_t{leaf_side} * leaf_side * leaf_side) {
            constexpr int level_of_leaves = 1;
            if (first != CellStatus::not_seen)
                voxels.addTile(level_of_leaves, openvdb::Coord(leaf.x, leaf.y, leaf.z),
                               static_cast<float>(first), true);
            return;
        }
        for_each_cell(grid.spec, leaf, [&](const openvdb::Coord& at, std::size_t cell) {
            if (grid.status[cell] != CellStatus::not_seen)
                voxels.setValue(at, static_cast<float>(grid.status[cell]));
        });
    });
    openvdb::tools::prune(made->tree());
    describe(*made, fmt::format("{}_status", level2::moment_name(grid.moment)), grid);
    std::string meanings;
    for (const CellStatus state : grid::states_of(grid.moment))
        meanings += fmt::format("{}{} {}", meanings.empty() ? "" : ", ", static_cast<int>(state),
                                grid::cell_status_name(state));
    made->insertMeta("states", openvdb::StringMetadata(meanings));
    return made;
}

// OpenVDB gives each file a random number. Replaces it by a hash, so that the same grids give the
// same bytes.
void replace_random_number(std::string& file) {
    constexpr std::size_t begin = 21, length = 36;  // after magic, three versions and a flag
    if (file.size() < begin + length) return;
    file.replace(begin, length, std::string(length, '0'));
    const std::uint64_t hash = xxh3_64(std::as_bytes(std::span(file)));
    const std::string digits = fmt::format("{0:016x}{1:016x}", hash, hash * 3);
    file.replace(begin, length,
                 fmt::format("{}-{}-{}-{}-{}", digits.substr(0, 8), digits.substr(8, 4),
                             digits.substr(12, 4), digits.substr(16, 4), digits.substr(20)));
}

Result<std::string> file_of(std::span<const grid::Grid> grids) {
    openvdb::initialize();
    openvdb::GridCPtrVec all;
    for (const grid::Grid& grid : grids) {
        all.push_back(values_of(grid));
        all.push_back(states_of(grid));
    }
    std::ostringstream stream(std::ios::binary);
    SeekableArchive().write_all(stream, all);
    all.clear();
    if (!stream) return fail(ErrorCode::exhausted, "there is no memory for the OpenVDB file");
    std::string file = std::move(stream).str();
    replace_random_number(file);
    return file;
}

}  // namespace
}  // namespace stormcellar::vdb

extern "C" __attribute__((visibility("default"))) void stormcellar_vdb_file(
    std::span<const stormcellar::grid::Grid> grids, stormcellar::Result<std::string>& bytes) {
    using stormcellar::ErrorCode;
    try {
        bytes = stormcellar::vdb::file_of(grids);
    } catch (const std::bad_alloc&) {
        bytes = stormcellar::fail(ErrorCode::exhausted, "there is no memory for the OpenVDB file");
    } catch (const std::exception& error) {
        bytes = stormcellar::fail(ErrorCode::internal, "OpenVDB: {}", error.what());
    }
}
