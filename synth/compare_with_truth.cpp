#include "synth/compare_with_truth.h"

#include <cmath>

#include "grid/plan/grid_ladder.h"
#include "synth/sampled_truth.h"

namespace stormcellar::synth {
namespace {

constexpr double clear_echo_dbz = 5;
constexpr double clearly_none_dbz = -5;

// The truth of a cell; NaN if there is nothing to compare with.
class CellTruth {
  public:
    CellTruth(const grid::GridScene& scene, const Scene& truth) : scene_(scene), truth_(truth) {
        const grid::Grid& base = scene.base();
        middle_ = base.start_time + (base.end_time - base.start_time) / 2;
    }
    [[nodiscard]] double at(const grid::ColumnPlace& column, double level_m) const {
        const PolarPlace place{static_cast<double>(column.azimuth_deg),
                               static_cast<double>(column.arc_m), level_m};
        if (scene_.options().moment == level2::Moment::vel) {
            return truth_.radial_velocity_mps(place, middle_).value_or(std::nan(""));
        }
        return truth_.at(place, middle_).dbz;
    }

  private:
    const grid::GridScene& scene_;
    SampledTruth truth_;
    UtcTime middle_;
};

TruthRow compare(const std::string& name, const grid::SampledCells& cells,
                 const std::vector<double>& truth, bool is_reflectivity) {
    TruthRow row;
    row.chain = name;
    std::vector<double> errors;
    std::size_t echo = 0, missed = 0, held = 0, invented = 0;
    double sum = 0;
    for (std::size_t at = 0; at < truth.size(); ++at) {
        const bool valued = cells.status[at] == grid::CellStatus::value;
        if (valued && std::isfinite(truth[at])) {
            errors.push_back(static_cast<double>(cells.values[at]) - truth[at]);
            sum += errors.back();
        }
        if (!is_reflectivity || cells.status[at] == grid::CellStatus::not_seen) continue;
        if (truth[at] > clear_echo_dbz) {
            ++echo;
            missed += valued ? 0 : 1;
        }
        if (valued && cells.values[at] > static_cast<float>(clear_echo_dbz)) {
            ++held;
            invented += truth[at] < clearly_none_dbz ? 1 : 0;
        }
    }
    row.error = accuracy::summarize(errors).value_or(accuracy::ErrorSummary{});
    const auto share = [](std::size_t part, std::size_t whole) {
        return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
    };
    row.mean = errors.empty() ? 0 : sum / static_cast<double>(errors.size());
    row.echo_missed = share(missed, echo);
    row.echo_invented = share(invented, held);
    return row;
}

}  // namespace

Result<std::vector<TruthRow>> compare_with_truth(grid::GridScene& scene, const Scene& truth,
                                                 std::size_t columns) {
    const grid::ColumnSample sample = scene.draw(columns, 3);
    const auto geometry = scene.geometry(grid::FrameKind::table);
    if (!geometry) return pass_on(geometry);
    const CellTruth cell_truth(scene, truth);
    std::vector<double> values;
    for (const auto& column : sample.columns) {
        const grid::ColumnPlace& place =
            (*geometry)->row(column.iy)[static_cast<std::size_t>(column.ix)];
        for (const double level_m : scene.spec().levels_m)
            values.push_back(cell_truth.at(place, level_m));
    }
    std::vector<TruthRow> rows;
    for (const grid::NamedChain& named :
         grid::named_chains(scene.options().moment, grid::Averaging::in_db)) {
        // simulated beams bend over a 4/3 earth
        if (named.choice.method.beam != grid::BeamKind::four_thirds) continue;
        const auto cells = scene.evaluate(named.choice, sample);
        if (!cells) return pass_on(cells);
        rows.push_back(
            compare(named.name, *cells, values, scene.options().moment == level2::Moment::ref));
    }
    return rows;
}

}  // namespace stormcellar::synth
