#include "retrieve/shear/median_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stormcellar::retrieve {
namespace {

constexpr double gap_spacings = 1.5;
constexpr std::size_t lanes = 64;  // gates that are filtered at once
using Lanes = std::array<float, lanes>;
using Nine = std::array<float, 9>;

inline void sort_pair(float& low, float& high) {
    const float a = low, b = high;
    low = b < a ? b : a;
    high = b < a ? a : b;
}

// Returns the fifth smallest number. First sorts three triples. The result is then the median of
// three numbers: the largest of the triples' least numbers, the median of their middle numbers, and
// the least of their largest numbers.
inline float median_of(Nine v) {
    for (std::size_t i = 0; i < 9; i += 3) {
        sort_pair(v[i + 1], v[i + 2]);
        sort_pair(v[i], v[i + 1]);
        sort_pair(v[i + 1], v[i + 2]);
    }
    sort_pair(v[0], v[3]);
    sort_pair(v[3], v[6]);  // v[6] is the largest of the least
    sort_pair(v[5], v[8]);
    sort_pair(v[2], v[5]);  // v[2] is the least of the largest
    sort_pair(v[4], v[7]);
    sort_pair(v[1], v[4]);
    sort_pair(v[4], v[7]);  // v[4] is the middle of the middle
    sort_pair(v[6], v[4]);
    sort_pair(v[4], v[2]);
    sort_pair(v[6], v[4]);
    return v[4];
}

// Replaces missing velocities by numbers beyond all others, of alternate sign beginning with
// `next`, so that the fifth smallest of the nine numbers is in the middle of the present
// velocities.
inline Nine filled(Nine v, float next) {
    for (float& of : v) {
        const bool is_missing = !(of == of);
        of = is_missing ? next : of;
        next = is_missing ? -next : next;
    }
    return v;
}

void select_medians(const std::array<Lanes, 9>& of, Lanes& medians) {
    constexpr float beyond = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < lanes; ++i) {
        const Nine nine{of[0][i], of[1][i], of[2][i], of[3][i], of[4][i],
                        of[5][i], of[6][i], of[7][i], of[8][i]};
        medians[i] = (median_of(filled(nine, -beyond)) + median_of(filled(nine, beyond))) / 2;
    }
}

// Copies the lanes of a row from `gate` on; NaN beyond the row.
void copy_lanes(const float* row, std::ptrdiff_t gates, std::ptrdiff_t gate, Lanes& to) {
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    if (row != nullptr && gate >= 0 && gate + static_cast<std::ptrdiff_t>(lanes) <= gates) {
        std::copy_n(row + gate, lanes, to.begin());
        return;
    }
    for (std::size_t i = 0; i < lanes; ++i) {
        const std::ptrdiff_t at = gate + static_cast<std::ptrdiff_t>(i);
        to[i] = row != nullptr && at >= 0 && at < gates ? row[at] : none;
    }
}

// Filters one row. `beside` are the row before it, the row itself and the row after it; null beyond
// a gap.
void filter_row(const std::array<const float*, 3>& beside, std::size_t gates, float* out) {
    for (std::size_t first = 0; first < gates; first += lanes) {
        const std::size_t count = std::min(lanes, gates - first);
        const float* middle = beside[1] + first;
        if (std::all_of(middle, middle + count, [](float v) { return std::isnan(v); })) continue;
        std::array<Lanes, 9> nine;
        for (std::size_t i = 0; i < 9; ++i)
            copy_lanes(beside[i / 3], static_cast<std::ptrdiff_t>(gates),
                       static_cast<std::ptrdiff_t>(first + i % 3) - 1, nine[i]);
        Lanes medians;
        select_medians(nine, medians);
        for (std::size_t i = 0; i < count; ++i)
            if (!std::isnan(middle[i])) out[first + i] = medians[i];
    }
}

}  // namespace

std::vector<float> median_filtered(const VelocityRows& rows) {
    std::vector<float> filtered = rows.velocities_mps;
    const std::size_t count = rows.row_count();
    const auto neighbor = [&](std::size_t row, std::size_t other) -> const float* {
        const double turn = std::remainder(
            static_cast<double>(rows.azimuths_deg[other] - rows.azimuths_deg[row]), 360.0);
        const bool is_beside =
            other != row && std::abs(turn) <= gap_spacings * rows.azimuth_spacing_deg;
        return is_beside ? rows.row(other) : nullptr;
    };
    for (std::size_t row = 0; row < count; ++row) {
        const std::size_t before = (row + count - 1) % count, after = (row + 1) % count;
        const float* of_after = after == before ? nullptr : neighbor(row, after);
        filter_row({neighbor(row, before), rows.row(row), of_after}, rows.gates,
                   filtered.data() + row * rows.gates);
    }
    return filtered;
}

}  // namespace stormcellar::retrieve
