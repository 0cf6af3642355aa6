#include "retrieve/quality/additive_rule.h"

#include <algorithm>

namespace stormcellar::retrieve {
namespace {

float interpolated(std::span<const Knot> knots, float at) {
    const auto after = std::ranges::find_if(knots, [at](const Knot& knot) { return knot.at > at; });
    if (after == knots.begin()) return knots.front().log_odds;
    if (after == knots.end()) return knots.back().log_odds;
    const Knot& before = *(after - 1);
    const float share = (at - before.at) / (after->at - before.at);
    return before.log_odds + share * (after->log_odds - before.log_odds);
}

}  // namespace

RuleTables::RuleTables(const AdditiveRule& rule) : constant_(rule.constant) {
    for (const RuleTerm& term : rule.terms) {
        table_of_[static_cast<std::size_t>(term.feature)] = tables_.size();
        Table& table = tables_.emplace_back();
        const float span = term.knots.back().at - term.knots.front().at;
        table.first = term.knots.front().at;
        table.steps_per_unit = static_cast<float>(steps - 1) / span;
        for (std::size_t step = 0; step < steps; ++step)
            table.log_odds[step] = interpolated(
                term.knots, table.first + static_cast<float>(step) / table.steps_per_unit);
        table.log_odds[missing_step] = term.missing;
    }
}

void RuleTables::add(Feature feature, std::span<const float> values, float* log_odds) const {
    const Table& table = tables_[table_of_[static_cast<std::size_t>(feature)]];
    // Compilers vectorize the first loop of a block, but not the search in the table.
    std::array<std::int32_t, 256> places{};
    for (std::size_t begin = 0; begin < values.size(); begin += places.size()) {
        const std::size_t count = std::min(places.size(), values.size() - begin);
        const float* from = values.data() + begin;
        for (std::size_t i = 0; i < count; ++i) {
            const bool is_missing = from[i] != from[i];
            const float value = is_missing ? table.first : from[i];
            const float step = (value - table.first) * table.steps_per_unit + 0.5F;
            const float low = step < most_step ? step : most_step;
            const auto place = static_cast<std::int32_t>(low > 0 ? low : 0);
            places[i] = is_missing ? missing_step : place;
        }
        for (std::size_t i = 0; i < count; ++i)
            log_odds[begin + i] += table.log_odds[static_cast<std::size_t>(places[i])];
    }
}

}  // namespace stormcellar::retrieve
