#include "grid/plan/grid_scene.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "accuracy/quantile_bound.h"
#include "accuracy/timing.h"
#include "base/memory.h"
#include "grid/fill/column_filler.h"
#include "grid/plan/cell_circle.h"
#include "grid/plan/column_sizes.h"
#include "grid/plan/position_error.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::grid {
namespace {

Tile tile_of_one(const ColumnGeometry& geometry, int ix, int iy) {
    const ColumnPlace& at = geometry.row(iy)[static_cast<std::size_t>(ix)];
    const PolarBounds bounds{at.azimuth_deg, at.azimuth_deg, at.arc_m, at.arc_m};
    return {ix, ix + 1, iy, iy + 1, bounds.widened(0.01F, 0)};
}

// Returns an integer below `size`. The result is the same on every machine.
std::uint64_t below(std::uint64_t size, std::mt19937_64& random) {
    return random() % size;  // uneven by less than 1 in 2^32, for a size below 2^32
}

}  // namespace

std::optional<double> SampledErrors::p99_bound() const {
    if (is_census) return p99_estimate();
    return accuracy::quantile_upper_bound(clusters, most_weight, {});
}

double SampledErrors::mean_load() const {
    double sum = 0;
    for (const accuracy::ErrorCluster& cluster : clusters)
        sum += cluster.weight * static_cast<double>(cluster.errors.size());
    return clusters.empty() ? 0 : sum / (most_weight * static_cast<double>(clusters.size()));
}

double SampledErrors::p99_estimate() const {
    const auto summary = accuracy::summarize(clusters);
    return summary ? summary->p99 : 0;
}

Result<GridScene> GridScene::make(const level2::Volume& volume, const SitePosition& site,
                                  const GridSpec& spec, const SceneOptions& options) {
    GridScene scene;
    scene.volume_ = &volume;
    scene.site_ = site;
    scene.spec_ = spec;
    scene.options_ = options;
    if (!(options.beam_width_deg > 0)) scene.options_.beam_width_deg = beam_width_of(site.icao);
    scene.chosen_ = choose_sweeps(volume, options.moment, scene.options_.beam_width_deg / 2,
                                  options.nearest_to);
    const auto geometry = scene.geometry(FrameKind::table);
    if (!geometry) return pass_on(geometry);
    GridderOptions gridder;
    gridder.moment = options.moment;
    gridder.beam_width_deg = scene.options_.beam_width_deg;
    gridder.threads = options.threads;
    gridder.frame_time = options.nearest_to;
    if (options.nearest_to) gridder.repeats = GridderOptions::Repeats::nearest_in_time;
    const double start_s = scene.now_s();
    auto base = make_grid(volume, site, **geometry, gridder);
    scene.base_seconds_ = scene.now_s() - start_s;
    if (!base) return pass_on(base);
    scene.base_ = std::move(*base);
    scene.sizes_ = column_sizes(scene.base_, scene.stack(Method{}), **geometry);
    return scene;
}

Result<std::shared_ptr<const ColumnGeometry>> GridScene::geometry(FrameKind kind) {
    auto& kept = geometries_[kind];
    if (kept == nullptr) {
        auto made = make_column_geometry(site_, spec_, kind);
        if (!made) return pass_on(made);
        kept = std::move(*made);
    }
    return kept;
}

const GridScene::KeptStack& GridScene::kept(const Method& method) {
    KeptStack& kept = stacks_[{method.beam, method.averaging, method.on_circle, method.cell}];
    if (kept.stack == nullptr) {
        const double start_s = accuracy::thread_s();
        kept.stack = std::make_unique<const SweepStack>(
            make_stack(*volume_, site_, chosen_,
                       {options_.moment, options_.beam_width_deg, method, options_.profile}));
        kept.seconds = accuracy::thread_s() - start_s;
    }
    return kept;
}

double GridScene::now_s() const {
    return options_.threads == 1 ? accuracy::thread_s() : accuracy::monotonic_s();
}

Grid& GridScene::scratch() {
    if (scratch_ == nullptr) {
        scratch_ = std::make_unique<Grid>();
        scratch_->spec = spec_;
        scratch_->moment = options_.moment;
        scratch_->values = zeros_in_large_pages<float>(spec_.cell_count());
        scratch_->status = zeros_in_large_pages<CellStatus>(spec_.cell_count());
    }
    return *scratch_;
}

std::span<const Tile> GridScene::tiles() const {
    return geometries_.at(FrameKind::table)->tiles();
}

Result<double> GridScene::fill(const Method& method, std::span<const Tile> tiles) {
    const auto at = geometry(FrameKind::table);
    if (!at) return pass_on(at);
    const SweepStack& sweeps = stack(method);
    Grid& grid = scratch();
    const auto nz = static_cast<std::ptrdiff_t>(spec_.levels_m.size());
    for (const Tile& tile : tiles) {
        for (int iy = tile.first_y; iy < tile.end_y; ++iy) {
            const auto first =
                grid.status.begin() + static_cast<std::ptrdiff_t>(spec_.index(tile.first_x, iy, 0));
            std::fill(first, first + nz * (tile.end_x - tile.first_x), CellStatus::not_seen);
        }
    }
    const double start_s = now_s();
    fill_grid(sweeps, **at, tiles, method, options_.threads, grid);
    return now_s() - start_s;
}

double GridScene::reach_m() const {
    return grid::reach_m({*volume_, site_, spec_, chosen_, options_.profile, options_.moment});
}

std::size_t GridScene::columns_with_echo() const {
    return static_cast<std::size_t>(
        std::count_if(sizes_.begin(), sizes_.end(), [](std::uint16_t size) { return size > 0; }));
}

ColumnSample GridScene::draw(std::size_t count, std::uint64_t seed) const {
    std::vector<std::uint64_t> ends;  // running sums of the sizes
    ends.reserve(sizes_.size());
    std::uint64_t total = 0;
    for (const std::uint16_t size : sizes_)
        ends.push_back(total += size);

    std::map<std::size_t, int> draws;
    ColumnSample sample;
    sample.is_census = columns_with_echo() <= count + count / 2;
    if (sample.is_census) {
        for (std::size_t column = 0; column < sizes_.size(); ++column) {
            if (sizes_[column] > 0) draws[column] = 1;
        }
    } else {
        std::mt19937_64 random(seed);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint64_t at = below(total, random);
            const auto end = std::upper_bound(ends.begin(), ends.end(), at);
            ++draws[static_cast<std::size_t>(end - ends.begin())];
        }
    }
    const ColumnGeometry& geometry = *geometries_.at(FrameKind::table);
    for (const auto& [column, times] : draws) {
        const int ix = static_cast<int>(column % static_cast<std::size_t>(spec_.nx));
        const int iy = static_cast<int>(column / static_cast<std::size_t>(spec_.nx));
        const double weight =
            sample.is_census ? 1
                             : 1 / static_cast<double>(std::max<std::uint16_t>(1, sizes_[column]));
        sample.columns.push_back({ix, iy, weight, times});
        sample.tiles.push_back(tile_of_one(geometry, ix, iy));
    }
    return sample;
}

Result<SampledCells> GridScene::evaluate(const SceneChoice& choice, const ColumnSample& sample) {
    const auto at = geometry(choice.frame);
    if (!at) return pass_on(at);
    const SweepStack& sweeps = stack(choice.method);
    Grid& grid = scratch();
    std::vector<Tile> own_tiles;
    if (choice.frame == FrameKind::sphere) {
        for (const ColumnSample::Drawn& column : sample.columns)
            own_tiles.push_back(tile_of_one(**at, column.ix, column.iy));
    }
    const std::size_t nz = spec_.levels_m.size();
    const auto cells_of = [&](const ColumnSample::Drawn& column) {
        return static_cast<std::ptrdiff_t>(spec_.index(column.ix, column.iy, 0));
    };
    for (const ColumnSample::Drawn& column : sample.columns) {
        const auto first = grid.status.begin() + cells_of(column);
        std::fill(first, first + static_cast<std::ptrdiff_t>(nz), CellStatus::not_seen);
    }
    fill_grid(sweeps, **at, own_tiles.empty() ? sample.tiles : own_tiles, choice.method,
              options_.threads, grid);
    SampledCells cells;
    for (const ColumnSample::Drawn& column : sample.columns) {
        const std::ptrdiff_t first = cells_of(column);
        const std::ptrdiff_t last = first + static_cast<std::ptrdiff_t>(nz);
        cells.status.insert(cells.status.end(), grid.status.begin() + first,
                            grid.status.begin() + last);
        cells.values.insert(cells.values.end(), grid.values.begin() + first,
                            grid.values.begin() + last);
    }
    return cells;
}

SampledErrors GridScene::compare(const SampledCells& cells, const SampledCells& exact,
                                 const ColumnSample& sample) const {
    SampledErrors errors;
    errors.most_weight = sample.most_weight;
    errors.is_census = sample.is_census;
    const std::size_t nz = spec_.levels_m.size();
    const ColumnGeometry& geometry = *geometries_.at(FrameKind::table);
    CellCircles circles(*volume_, chosen_, site_, spec_, options_.moment);
    for (std::size_t i = 0; i < sample.columns.size(); ++i) {
        const ColumnSample::Drawn& column = sample.columns[i];
        circles.move_to(static_cast<double>(
            geometry.row(column.iy)[static_cast<std::size_t>(column.ix)].arc_m));
        accuracy::ErrorCluster cluster;
        cluster.weight = column.weight;
        accuracy::StatusCounts status;
        for (std::size_t at = i * nz; at < (i + 1) * nz; ++at) {
            ++status.compared;
            if (cells.status[at] != exact.status[at]) {
                ++status.disagreeing;
            } else if (exact.status[at] == CellStatus::value) {
                cluster.errors.push_back(
                    circles.difference(cells.values[at], exact.values[at], at - i * nz));
            }
        }
        for (int draw = 0; draw < column.draws; ++draw) {
            errors.clusters.push_back(cluster);
            errors.status += status;
        }
    }
    return errors;
}

}  // namespace stormcellar::grid
