#include "grid/column.h"

#include <algorithm>

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

// Levels are taken from the lowest up; each step fills those below the next beam, so that a stretch
// between two beams that hold the same state is filled at once. Most of the sky is such.
void fill_column(std::span<const BeamSample> beams, std::span<const float> levels_m,
                 Blending blending, std::span<CellStatus> status, std::span<float> values) {
    const auto put = [&](std::size_t level, CellResult cell) {
        status[level] = cell.status;
        if (cell.status == CellStatus::value) values[level] = cell.value;
    };
    std::size_t level = 0;
    for (; level < levels_m.size() && levels_m[level] < beams.front().height_m; ++level) {
        const bool within = levels_m[level] >= beams.front().lower_edge_m;
        put(level, within ? alone(beams.front().sample) : CellResult{});
    }
    for (std::size_t above = 1; above < beams.size() && level < levels_m.size(); ++above) {
        const BeamSample& low = beams[above - 1];
        const BeamSample& high = beams[above];
        std::size_t end = level;
        while (end < levels_m.size() && levels_m[end] < high.height_m)
            ++end;
        const bool alike = low.sample.status == high.sample.status &&
                           low.sample.status != CellStatus::value && low.adjacent_to_next;
        if (alike) {
            std::fill(status.begin() + static_cast<std::ptrdiff_t>(level),
                      status.begin() + static_cast<std::ptrdiff_t>(end), low.sample.status);
            level = end;
            continue;
        }
        // The beams differ here: low.height_m <= levels_m[level] < high.height_m.
        const float span_m = high.height_m - low.height_m;
        for (; level < end; ++level) {
            const float weight = (levels_m[level] - low.height_m) / span_m;
            put(level, low.adjacent_to_next ? blend(low.sample, high.sample, weight, blending)
                                            : beside_a_gap(low, high, levels_m[level]));
        }
    }
    for (; level < levels_m.size(); ++level) {
        const bool within = levels_m[level] <= beams.back().upper_edge_m;
        put(level, within ? alone(beams.back().sample) : CellResult{});
    }
}

}  // namespace stormcellar::grid
