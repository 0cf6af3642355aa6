#include "grid/fill/column.h"

#include <algorithm>
#include <cstring>

#include "grid/fill/beam_choice.h"

namespace stormcellar::grid {
namespace {

// Fills the levels of a column from the lowest up, with one call for each pair of beams. Leaves
// levels that are not seen as they are.
template <bool nearest, bool circular>
class Filler {
  public:
    Filler(const LevelTable& levels, Blending blending, std::span<CellStatus> status,
           std::span<float> values)
        : levels_(levels), blending_(blending), status_(status), values_(values) {}

    // Fills the levels below the lowest beam, down to its lower edge.
    void below(const BeamSample& lowest) {
        // Near the antenna, rounding may put the edge above the beam.
        level_ = levels_.first_from(std::min(lowest.lower_edge_m, lowest.height_m));
        fill_to(levels_.first_from(lowest.height_m), lowest.sample);
    }

    // Fills the levels from `low` to below `high`. If both beams have the same state, and this
    // state is not `value`, all levels between them have this state. Such levels form a run. This
    // function only notes the run; end_run() fills it.
    void between(const BeamSample& low, const BeamSample& high) {
        const bool same_state = low.sample.status == high.sample.status;
        if (same_state && low.adjacent_to_next && low.sample.status != CellStatus::value) {
            in_run_ = true;
            return;
        }
        end_run(low);
        const std::size_t end = levels_.first_from(high.height_m);
        if (end <= level_) return;
        if (!low.adjacent_to_next) {
            for (; level_ < end; ++level_) {
                const BeamSample* const beam = beam_alone(&low, &high, levels_[level_]);
                if (beam != nullptr) put({beam->sample.status, beam->sample.value});
            }
        } else if (!same_state || circular) {
            blend_between(low, high, end);
        } else {
            values_between(low, high, end);
        }
    }

    // Fills the levels above the highest beam, up to its upper edge.
    void above(const BeamSample& highest) {
        end_run(highest);
        std::size_t end = level_;
        while (end < levels_.size() && levels_[end] <= highest.upper_edge_m)
            ++end;
        fill_to(end, highest.sample);
    }

  private:
    void put(CellResult cell) {
        status_[level_] = cell.status;
        if (cell.status == CellStatus::value) values_[level_] = cell.value;
    }
    void fill_to(std::size_t end, const Sample& sample) {
        if (end <= level_) return;
        if (sample.status != CellStatus::not_seen)
            std::memset(status_.data() + level_, static_cast<int>(sample.status), end - level_);
        if (sample.status == CellStatus::value)
            std::fill(values_.data() + level_, values_.data() + end, sample.value);
        level_ = end;
    }
    // Fills a run of levels with the same state. The run ends at the beam `last`.
    void end_run(const BeamSample& last) {
        if (in_run_) fill_to(levels_.first_from(last.height_m), last.sample);
        in_run_ = false;
    }

    // Returns the share of the beam `high` at the present level, which is at or above `low` and
    // below `high`.
    [[nodiscard]] float share(const BeamSample& low, float inverse_m) const {
        return upper_share((levels_[level_] - low.height_m) * inverse_m, nearest);
    }

    // Handles the general case, in which the two states differ or values wrap. The status rule
    // decides each cell.
    void blend_between(const BeamSample& low, const BeamSample& high, std::size_t end) {
        const float inverse_m = 1 / (high.height_m - low.height_m);
        for (; level_ < end; ++level_)
            put(blend_as<circular>(low.sample, high.sample, share(low, inverse_m), blending_));
    }

    // Handles the usual case inside echo, in which both beams have values. A plain loop
    // interpolates them.
    void values_between(const BeamSample& low, const BeamSample& high, std::size_t end) {
        const float inverse_m = 1 / (high.height_m - low.height_m);
        const float first = low.sample.value;
        const float second = high.sample.value;
        for (; level_ < end; ++level_) {
            const float weight = share(low, inverse_m);
            status_[level_] = CellStatus::value;
            values_[level_] = (1 - weight) * first + weight * second;
        }
    }

    const LevelTable& levels_;
    Blending blending_;
    std::span<CellStatus> status_;
    std::span<float> values_;
    std::size_t level_ = 0;
    bool in_run_ = false;
};

}  // namespace

template <bool nearest, bool circular>
void fill_column_as(std::span<const BeamSample> beams, const LevelTable& levels, Blending blending,
                    std::span<CellStatus> status, std::span<float> values) {
    Filler<nearest, circular> filler(levels, blending, status, values);
    filler.below(beams.front());
    for (std::size_t above = 1; above < beams.size(); ++above)
        filler.between(beams[above - 1], beams[above]);
    filler.above(beams.back());
}

template void fill_column_as<false, false>(std::span<const BeamSample>, const LevelTable&, Blending,
                                           std::span<CellStatus>, std::span<float>);
template void fill_column_as<false, true>(std::span<const BeamSample>, const LevelTable&, Blending,
                                          std::span<CellStatus>, std::span<float>);
template void fill_column_as<true, false>(std::span<const BeamSample>, const LevelTable&, Blending,
                                          std::span<CellStatus>, std::span<float>);
template void fill_column_as<true, true>(std::span<const BeamSample>, const LevelTable&, Blending,
                                         std::span<CellStatus>, std::span<float>);

void fill_column(std::span<const BeamSample> beams, const LevelTable& levels, Blending blending,
                 ChosenInterpolation interpolation, std::span<CellStatus> status,
                 std::span<float> values) {
    const bool circular = is_circular(blending);
    if (interpolation == Interpolation::nearest) {
        const auto fill = circular ? fill_column_as<true, true> : fill_column_as<true, false>;
        return fill(beams, levels, blending, status, values);
    }
    const auto fill = circular ? fill_column_as<false, true> : fill_column_as<false, false>;
    fill(beams, levels, blending, status, values);
}

}  // namespace stormcellar::grid
