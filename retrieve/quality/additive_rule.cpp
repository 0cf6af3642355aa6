#include "retrieve/quality/additive_rule.h"

#include <algorithm>

#include "retrieve/quality/gate_loops.h"

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
        table.log_odds[last_step + 1] = term.missing;
    }
}

void RuleTables::add(Feature feature, std::span<const float> values, float* log_odds) const {
    const Table& table = tables_[table_of_[static_cast<std::size_t>(feature)]];
    add_entries(values.data(), values.size(),
                {table.first, table.steps_per_unit, last_step, table.log_odds.data()}, log_odds);
}

}  // namespace stormcellar::retrieve
