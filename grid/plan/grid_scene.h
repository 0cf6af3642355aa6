// grid/plan/grid_scene.h -- one volume over one grid spec, gridded in any way, whole or in sampled
// columns: what the accuracy planner measures on.
//
// What several ways share (geometries, prepared sweeps) is made once and kept as long as the scene.
// A sample's columns are drawn in proportion to how many cells of theirs may hold a value, so that
// few are wasted on clear air; where there are few enough, all of them are taken.
// Threads: use a scene from one thread; it starts up to `threads` of its own.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "grid/sweep/sweep_stack.h"
#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/frame_ladder.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/refractivity.h"

namespace stormcellar::grid {

// One rung of every step.
struct SceneChoice {
    FrameKind frame = FrameKind::table;
    Method method;
    bool operator==(const SceneChoice&) const = default;
};

struct SceneOptions {
    level2::Moment moment = level2::Moment::ref;
    double beam_width_deg = 0;  // 0: that of the site's radar
    RefractivityProfile profile = RefractivityProfile::reference();
    int threads = 1;
    // Of repeated sweeps the nearest to this time is taken; none: the newest.
    std::optional<UtcTime> nearest_to = std::nullopt;
};

// Columns that were drawn, with replacement or all.
struct ColumnSample {
    struct Drawn {
        int ix = 0, iy = 0;
        double weight = 1;  // columns of the grid that each draw stands for, in some scale
        int draws = 1;
    };
    std::vector<Drawn> columns;
    std::vector<Tile> tiles;  // one column each, in the same order
    bool is_census = false;   // all columns that may hold a value
    double most_weight = 1;   // weight * cells of any column that could have been drawn
};

// The cells of the sampled columns, one after the other.
struct SampledCells {
    std::vector<CellStatus> status;
    std::vector<float> values;
};

// One way against another on the same gates; values of moments that wrap differ by the shorter way
// round (grid/plan/cell_circle.h).
struct SampledErrors {
    std::vector<accuracy::ErrorCluster> clusters;  // of cells valued in both, a column each
    accuracy::StatusCounts status;
    double most_weight = 1;
    bool is_census = false;

    // Of the magnitudes of all errors: an upper bound of the 99th percentile at 99.9 % confidence
    // (the figure itself of a census); none when the sample is too small.
    [[nodiscard]] std::optional<double> p99_bound() const;
    // How much a column holds of the most that it may: 0 to 1, the mean.
    [[nodiscard]] double mean_load() const;
    // Of the sample itself; 0 when nothing is valued in both.
    [[nodiscard]] double p99_estimate() const;
};

class GridScene {
  public:
    // Errors: as make_grid() and make_column_geometry(). The volume must outlive the scene.
    [[nodiscard]] static Result<GridScene> make(const level2::Volume& volume,
                                                const SitePosition& site, const GridSpec& spec,
                                                const SceneOptions& options);

    // The grid made the default way; where values are in it says where to sample.
    [[nodiscard]] const Grid& base() const { return base_; }
    // That making it took. Of one thread: of the processor, whatever else the machine does; of
    // several: by the clock. Likewise all seconds of a scene.
    [[nodiscard]] double base_seconds() const { return base_seconds_; }

    // About `count` columns, drawn by a generator of this seed.
    [[nodiscard]] ColumnSample draw(std::size_t count, std::uint64_t seed) const;
    [[nodiscard]] Result<SampledCells> evaluate(const SceneChoice& choice,
                                                const ColumnSample& sample);
    [[nodiscard]] SampledErrors compare(const SampledCells& cells, const SampledCells& exact,
                                        const ColumnSample& sample) const;
    // Columns that may hold a value.
    [[nodiscard]] std::size_t columns_with_echo() const;
    [[nodiscard]] bool may_hold_value(int ix, int iy) const {
        return sizes_[static_cast<std::size_t>(iy) * static_cast<std::size_t>(spec_.nx) +
                      static_cast<std::size_t>(ix)] > 0;
    }
    // All tiles of the grid, and the seconds that filling some of them takes (the frame's table).
    [[nodiscard]] std::span<const Tile> tiles() const;
    [[nodiscard]] Result<double> fill(const Method& method, std::span<const Tile> tiles);

    [[nodiscard]] const level2::Volume& volume() const { return *volume_; }
    [[nodiscard]] const SitePosition& site() const { return site_; }
    [[nodiscard]] const GridSpec& spec() const { return spec_; }
    [[nodiscard]] const SceneOptions& options() const { return options_; }
    [[nodiscard]] const std::vector<ChosenSweep>& chosen() const { return chosen_; }
    // The lesser of the farthest column's and the farthest gate's arc.
    [[nodiscard]] double reach_m() const;
    [[nodiscard]] Result<std::shared_ptr<const ColumnGeometry>> geometry(FrameKind kind);
    [[nodiscard]] const SweepStack& stack(const Method& method) { return *kept(method).stack; }
    // That making it took.
    [[nodiscard]] double stack_seconds(const Method& method) { return kept(method).seconds; }

  private:
    using StackKey = std::tuple<BeamKind, Averaging, bool, CellExtent>;

    struct KeptStack {
        std::unique_ptr<const SweepStack> stack;
        double seconds = 0;
    };

    GridScene() = default;
    [[nodiscard]] const KeptStack& kept(const Method& method);
    // One thread counts what it gets of the processor, several go by the clock.
    [[nodiscard]] double now_s() const;
    // Where columns are filled that nobody asked to keep.
    [[nodiscard]] Grid& scratch();
    // The cells of each column that may hold a value by any method.
    [[nodiscard]] std::vector<std::uint16_t> sizes() const;

    const level2::Volume* volume_ = nullptr;
    SitePosition site_;
    GridSpec spec_;
    SceneOptions options_;
    std::vector<ChosenSweep> chosen_;
    std::map<FrameKind, std::shared_ptr<const ColumnGeometry>> geometries_;
    std::map<StackKey, KeptStack> stacks_;
    Grid base_;
    double base_seconds_ = 0;
    std::unique_ptr<Grid> scratch_;
    std::vector<std::uint16_t> sizes_;
};

}  // namespace stormcellar::grid
