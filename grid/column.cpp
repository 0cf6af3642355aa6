#include "grid/column.h"

namespace stormcellar::grid {
namespace {

CellResult alone(const Sample& sample) {
    return {sample.status, sample.value};
}

// Between two sweeps that are not adjacent: only what a beam itself covers.
CellResult beside_a_gap(const BeamSample& below, const BeamSample& above, float level_m) {
    const bool in_below = level_m <= below.upper_edge_m;
    const bool in_above = level_m >= above.lower_edge_m;
    const bool below_is_nearer = level_m - below.height_m <= above.height_m - level_m;
    if (in_below && (below_is_nearer || !in_above)) return alone(below.sample);
    if (in_above) return alone(above.sample);
    return {};
}

float value_in(const Sample& sample, Blending blending, float weight, float& total_weight) {
    if (sample.status == CellStatus::value) {
        total_weight += weight;
        return weight * sample.value;
    }
    if (sample.status == CellStatus::no_echo && blending == Blending::with_detection_limit) {
        total_weight += weight;
        return weight * sample.limit_dbz;
    }
    return 0;
}

}  // namespace

Blending blending_of(level2::Moment moment) {
    switch (moment) {
        case level2::Moment::ref:
            return Blending::with_detection_limit;
        case level2::Moment::vel:
        case level2::Moment::phi:
            return Blending::nearest;
        default:
            return Blending::values_only;
    }
}

CellResult blend(const Sample& a, const Sample& b, float weight_b, Blending blending) {
    const float weight_a = 1 - weight_b;
    if (a.status == b.status && a.status != CellStatus::value) return {a.status, 0};

    const auto weight_of = [&](CellStatus status) {
        return (a.status == status ? weight_a : 0) + (b.status == status ? weight_b : 0);
    };
    const float v = weight_of(CellStatus::value);
    const float n = weight_of(CellStatus::no_echo);
    const float f = weight_of(CellStatus::range_folded);
    if (weight_of(CellStatus::not_seen) > 0.5F) return {CellStatus::not_seen, 0};
    if (f > v && f > n) return {CellStatus::range_folded, 0};
    if (v < n) return {CellStatus::no_echo, 0};

    if (blending == Blending::nearest) {
        const bool take_b =
            b.status == CellStatus::value && (a.status != CellStatus::value || weight_b > weight_a);
        return alone(take_b ? b : a);
    }
    float total_weight = 0;
    const float sum = value_in(a, blending, weight_a, total_weight) +
                      value_in(b, blending, weight_b, total_weight);
    return {CellStatus::value, sum / total_weight};
}

void fill_column(std::span<const BeamSample> beams, std::span<const float> levels_m,
                 Blending blending, std::span<CellStatus> status, std::span<float> values) {
    std::size_t above = 0;  // the first beam above the level
    for (std::size_t level = 0; level < levels_m.size(); ++level) {
        const float level_m = levels_m[level];
        while (above < beams.size() && beams[above].height_m <= level_m)
            ++above;
        CellResult cell;
        if (above == 0) {
            if (level_m >= beams.front().lower_edge_m) cell = alone(beams.front().sample);
        } else if (above == beams.size()) {
            if (level_m <= beams.back().upper_edge_m) cell = alone(beams.back().sample);
        } else {
            const BeamSample& low = beams[above - 1];
            const BeamSample& high = beams[above];
            if (low.adjacent_to_next) {
                // The beams differ here: low.height_m <= level_m < high.height_m.
                const float weight = (level_m - low.height_m) / (high.height_m - low.height_m);
                cell = blend(low.sample, high.sample, weight, blending);
            } else {
                cell = beside_a_gap(low, high, level_m);
            }
        }
        status[level] = cell.status;
        values[level] = cell.value;
    }
}

}  // namespace stormcellar::grid
