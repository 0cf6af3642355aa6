// grid/plan/grid_scene.h -- one volume over one grid spec, which is gridded by any method, as a
// whole or in sampled columns. The accuracy planner measures on it.
//
// A scene keeps geometries and prepared sweeps, because several methods use them. Columns are drawn
// in proportion to the number of their cells that may hold a value, so that few draws are wasted on
// clear air. If only a few columns may hold a value, all of these columns are taken.
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

// A choice of one rung for each step of gridding (grid/plan/grid_effects.h).
struct SceneChoice {
    FrameKind frame = FrameKind::table;
    Method method;
    bool operator==(const SceneChoice&) const = default;
};

struct SceneOptions {
    level2::Moment moment = level2::Moment::ref;
    double beam_width_deg = 0;  // 0: beam_width_of() the site
    RefractivityProfile profile = RefractivityProfile::reference();
    int threads = 1;
    // If sweeps repeat, uses the sweep nearest to this time; none: the newest sweep.
    std::optional<UtcTime> nearest_to = std::nullopt;
};

// Columns drawn with replacement, or all columns that may hold a value.
struct ColumnSample {
    struct Drawn {
        int ix = 0, iy = 0;
        double weight = 1;  // number of columns that a draw represents, up to a common factor
        int draws = 1;
    };
    std::vector<Drawn> columns;
    std::vector<Tile> tiles;  // one for each column, in the same order
    bool is_census = false;   // the sample has all columns that may hold a value
    double most_weight = 1;   // largest (weight * cells) of any column that could have been drawn
};

// The cells of the sampled columns, column by column.
struct SampledCells {
    std::vector<CellStatus> status;
    std::vector<float> values;
};

// The differences between two methods on the same gates. For moments that wrap, values differ by
// the shorter way around (grid/plan/cell_circle.h).
struct SampledErrors {
    // One cluster for each column. It has the cells with a value by both methods.
    std::vector<accuracy::ErrorCluster> clusters;
    accuracy::StatusCounts status;
    double most_weight = 1;
    bool is_census = false;

    // Returns an upper bound, at 99.9 % confidence, of the 99th percentile of the magnitudes of all
    // errors. For a census, returns the percentile itself. Returns none if the sample is too small.
    [[nodiscard]] std::optional<double> p99_bound() const;
    // Returns how full the sampled columns are, from 0 to 1: the mean over the clusters of (weight
    // * errors) / most_weight.
    [[nodiscard]] double mean_load() const;
    // Returns the 99th percentile of the sample itself; 0 if no cell has a value by both methods.
    [[nodiscard]] double p99_estimate() const;
};

class GridScene {
  public:
    // Makes a scene. The volume must outlive it. Errors: the errors of make_grid()
    // and make_column_geometry().
    [[nodiscard]] static Result<GridScene> make(const level2::Volume& volume,
                                                const SitePosition& site, const GridSpec& spec,
                                                const SceneOptions& options);

    // Returns the grid by the default method. This grid decides how columns are sampled.
    [[nodiscard]] const Grid& base() const { return base_; }
    // Returns the seconds that the base took. For one thread, all times of a scene are processor
    // time, whatever else the machine does. For several threads, they are elapsed time.
    [[nodiscard]] double base_seconds() const { return base_seconds_; }

    // Draws about `count` columns. `seed` seeds the random generator.
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
    // tiles() returns all tiles of the grid. fill() fills the given tiles, with the table as frame,
    // and returns how many seconds that took.
    [[nodiscard]] std::span<const Tile> tiles() const;
    [[nodiscard]] Result<double> fill(const Method& method, std::span<const Tile> tiles);

    [[nodiscard]] const level2::Volume& volume() const { return *volume_; }
    [[nodiscard]] const SitePosition& site() const { return site_; }
    [[nodiscard]] const GridSpec& spec() const { return spec_; }
    [[nodiscard]] const SceneOptions& options() const { return options_; }
    [[nodiscard]] const std::vector<ChosenSweep>& chosen() const { return chosen_; }
    // Returns the arc of the farthest column, or of the farthest gate if that is less.
    [[nodiscard]] double reach_m() const;
    [[nodiscard]] Result<std::shared_ptr<const ColumnGeometry>> geometry(FrameKind kind);
    [[nodiscard]] const SweepStack& stack(const Method& method) { return *kept(method).stack; }
    // Returns the seconds that it took to prepare the sweeps for the method.
    [[nodiscard]] double stack_seconds(const Method& method) { return kept(method).seconds; }

  private:
    using StackKey = std::tuple<BeamKind, Averaging, bool, CellExtent>;

    struct KeptStack {
        std::unique_ptr<const SweepStack> stack;
        double seconds = 0;
    };

    GridScene() = default;
    [[nodiscard]] const KeptStack& kept(const Method& method);
    [[nodiscard]] double now_s() const;
    // Returns a grid into which columns are filled that nobody reads.
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
