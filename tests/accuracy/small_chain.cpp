#include "tests/accuracy/small_chain.h"

#include <fmt/format.h>

namespace stormcellar::accuracy::testing {

Chain small_chain() {
    const auto effect = [](const char* name, const char* what, const char* rung, ErrorSize size,
                           Evidence evidence, double cost_s) {
        return Effect{name, what, rung, size, evidence, cost_s, Setting::automatic};
    };
    Chain chain;
    chain.cheapest_cost_s = 1;
    chain.steps.push_back(
        {"beam",
         "4/3 earth",
         {effect("refraction", "The beam bends more or less than over a 4/3 earth.", "ray traced",
                 {200, 0, 0}, Evidence::proven_bound, 1)}});
    chain.steps.push_back({"frame",
                           "sphere",
                           {effect("ellipsoid", "The earth is no sphere.", "ellipsoid", {240, 0, 0},
                                   Evidence::proven_bound, 0.1),
                            effect("geodesic", "The shortest line is no normal section.",
                                   "geodesic", {30, 0, 0}, Evidence::proven_bound, 2)}});
    chain.steps.push_back({"averaging",
                           "decibels",
                           {effect("linear_mean", "Power adds up, decibels do not.", "linear Z",
                                   {0, 0.3, 0}, Evidence::sample, 0.5)}});
    return chain;
}

Chain random_chain(std::mt19937_64& random) {
    const auto below = [&](unsigned n) { return static_cast<unsigned>(random() % n); };
    Chain chain;
    chain.cheapest_cost_s = below(3);
    const unsigned steps = below(5);
    for (unsigned i = 0; i < steps; ++i) {
        Step step;
        step.name = fmt::format("step{}", i);
        step.cheapest = "cheap";
        const unsigned effects = below(4);
        for (unsigned k = 0; k < effects; ++k) {
            Effect effect;
            effect.name = fmt::format("effect{}_{}", i, k);
            effect.rung = fmt::format("rung{}", k + 1);
            effect.predicted = {static_cast<double>(below(4)), static_cast<double>(below(3)),
                                static_cast<double>(below(2))};
            effect.evidence = below(2) == 0 ? Evidence::sample : Evidence::proven_bound;
            effect.cost_s = below(4);
            step.effects.push_back(effect);
        }
        // Some of the first effects are set on, and some of the last are set off; other effects
        // stay automatic.
        const unsigned on = effects > 0 && below(4) == 0 ? below(effects) : 0;
        for (unsigned k = 0; k < on; ++k)
            step.effects[k].setting = Setting::on;
        if (effects > on && below(4) == 0) step.effects[effects - 1].setting = Setting::off;
        chain.steps.push_back(step);
    }
    // A joint cost saves at most the cost of its second effect, so that no chain costs less than 0.
    for (std::size_t i = 1; i < chain.steps.size(); ++i) {
        if (chain.steps[i - 1].effects.empty() || chain.steps[i].effects.empty()) continue;
        const double spared_s = chain.steps[i].effects[0].cost_s;
        if (below(2) == 0) {
            chain.joint_costs.push_back({i - 1, 1, i, 1, below(2) == 0 ? below(3) : -spared_s});
        }
    }
    return chain;
}

Plan plan_of(const Chain& chain, const char* budget) {
    return plan(chain, parse_budget(budget).value()).value();
}

}  // namespace stormcellar::accuracy::testing
