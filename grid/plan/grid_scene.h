// grid/plan/grid_scene.h -- one volume over one grid spec, gridded by any method, whole or in
// sampled columns. The accuracy planner measures on it.
//
// Geometries and prepared sweeps serve several methods, so they are made once and kept as long as
// the scene. Columns are drawn in proportion to the number of their cells that may hold a value, so
// that few are wasted on clear air. If there are few enough such columns, all of them are taken.
//
// Threads   One thread at a time; a scene starts up to `threads` threads of its own.
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

// One rung for every step.
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
    // Uses the repeated sweep nearest to this time; none: the newest.
    std::optional<UtcTime> nearest_to = std::nullopt;
};

// Columns that were drawn with replacement, or all columns.
struct ColumnSample {
    struct Drawn {
        int ix = 0, iy = 0;
        double weight = 1;  // how many columns of the grid each draw stands for, in some scale
        int draws = 1;
    };
    std::vector<Drawn> columns;
    std::vector<Tile> tiles;  // one column each, in the same order
    bool is_census = false;   // true for all columns that may hold a value
    double most_weight = 1;   // weight * cells of any column that could have been drawn
};

// The cells of the sampled columns, one column after the other.
struct SampledCells {
    std::vector<CellStatus> status;
    std::vector<float> values;
};

// One method compared with another on the same gates. Values of moments that wrap differ by the
// shorter way round (grid/plan/cell_circle.h).
struct SampledErrors {
    // of cells with a value in both, one cluster for each column
    std::vector<accuracy::ErrorCluster> clusters;
    accuracy::StatusCounts status;
    double most_weight = 1;
    bool is_census = false;

    // Returns an upper bound of the 99th percentile of the magnitudes of all errors, at 99.9 %
    // confidence (for a census, the figure itself), or none if the sample is too small.
    [[nodiscard]] std::optional<double> p99_bound() const;
    // Returns the mean ratio, from 0 to 1, of what a sampled column holds to the most that it may
    // hold.
    [[nodiscard]] double mean_load() const;
    // Returns the 99th percentile of the sample itself; 0 if no cell has a value in both grids.
    [[nodiscard]] double p99_estimate() const;
};

class GridScene {
  public:
    // Makes a scene. The volume must outlive it. Errors: those of make_grid() and
    // make_column_geometry().
    [[nodiscard]] static Result<GridScene> make(const level2::Volume& volume,
                                                const SitePosition& site, const GridSpec& spec,
                                                const SceneOptions& options);

    // Returns the grid made by the default method, whose values say where to sample.
    [[nodiscard]] const Grid& base() const { return base_; }
    // Returns the seconds that making the base took. For one thread this is processor time,
    // whatever else the machine does; for several threads it is time by the clock. This holds for
    // all seconds of a scene.
    [[nodiscard]] double base_seconds() const { return base_seconds_; }

    // Draws about `count` columns with a generator of this seed.
    [[nodiscard]] ColumnSample draw(std::size_t count, std::uint64_t seed) const;
    [[nodiscard]] Result<SampledCells> evaluate(const SceneChoice& choice,
                                                const ColumnSample& sample);
    [[nodiscard]] SampledErrors compare(const SampledCells& cells, const SampledCells& exact,
                                        const ColumnSample& sample) const;
    // Returns the number of columns that may hold a value.
    [[nodiscard]] std::size_t columns_with_echo() const;
    [[nodiscard]] bool may_hold_value(int ix, int iy) const {
        return sizes_[static_cast<std::size_t>(iy) * static_cast<std::size_t>(spec_.nx) +
                      static_cast<std::size_t>(ix)] > 0;
    }
    // tiles() returns all tiles of the grid; fill() returns the seconds that filling some of them
    // takes (with the table as frame).
    [[nodiscard]] std::span<const Tile> tiles() const;
    [[nodiscard]] Result<double> fill(const Method& method, std::span<const Tile> tiles);

    [[nodiscard]] const level2::Volume& volume() const { return *volume_; }
    [[nodiscard]] const SitePosition& site() const { return site_; }
    [[nodiscard]] const GridSpec& spec() const { return spec_; }
    [[nodiscard]] const SceneOptions& options() const { return options_; }
    [[nodiscard]] const std::vector<ChosenSweep>& chosen() const { return chosen_; }
    // Returns the lesser of the arcs of the farthest column and the farthest gate.
    [[nodiscard]] double reach_m() const;
    [[nodiscard]] Result<std::shared_ptr<const ColumnGeometry>> geometry(FrameKind kind);
    [[nodiscard]] const SweepStack& stack(const Method& method) { return *kept(method).stack; }
    // Returns the seconds that making the sweeps for the method took.
    [[nodiscard]] double stack_seconds(const Method& method) { return kept(method).seconds; }

  private:
    using StackKey = std::tuple<BeamKind, Averaging, bool, CellExtent>;

    struct KeptStack {
        std::unique_ptr<const SweepStack> stack;
        double seconds = 0;
    };

    GridScene() = default;
    [[nodiscard]] const KeptStack& kept(const Method& method);
    // Returns processor time for one thread, and time by the clock for several.
    [[nodiscard]] double now_s() const;
    // Returns a grid for filled columns that nobody keeps.
    [[nodiscard]] Grid& scratch();

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
    std::vector<std::uint16_t> sizes_;  // grid/plan/column_sizes.h
};

}  // namespace stormcellar::grid
