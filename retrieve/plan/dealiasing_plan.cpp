#include "retrieve/plan/dealiasing_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "accuracy/governor.h"
#include "base/steady_time.h"
#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {
namespace {

using accuracy::Setting;

constexpr auto ladder =
    std::to_array({Dealiasing::off, Dealiasing::profile, Dealiasing::region, Dealiasing::anchored});

// The efforts are times over KTLX 1999 (docs/velocity.md), relative to a grid of nearest gates.
accuracy::Step make_ladder() {
    const auto effect = [](const char* name, Dealiasing rung, const char* what, double effort) {
        return accuracy::make_effect(name, std::string(dealiasing_name(rung)), what, effort);
    };
    return {
        "dealiasing",
        std::string(dealiasing_name(Dealiasing::off)),
        {effect("folds_by_wind", Dealiasing::profile,
                "Velocities beyond the Nyquist velocity come back on the other side; the wind "
                "at their height tells how often.",
                1),
         effect("folds_by_neighbors", Dealiasing::region,
                "Velocities of adjacent gates hardly differ, however often they are folded.", 1),
         effect("folds_by_anchors", Dealiasing::anchored,
                "Echo without neighbors is folded as the wind and the sweeps above and below "
                "tell.",
                5)}};
}

// The sweep with the most velocities, on which the rungs are timed.
struct TimedSweep {
    level2::Volume volume;
    double part = 0;  // of the volume's gates with a velocity
};

std::int64_t gates_of(const VelocitySheet& sheet) {
    return std::ranges::count_if(sheet.turns, [](float turns) { return !std::isnan(turns); });
}

TimedSweep take_sweep(const level2::Volume& volume, const std::vector<VelocitySheet>& sheets) {
    std::vector<std::int64_t> gates(volume.sweeps.size());
    for (const VelocitySheet& sheet : sheets)
        gates[sheet.sweep] += gates_of(sheet);
    const auto most = std::ranges::max_element(gates);
    TimedSweep taken;
    taken.part = static_cast<double>(*most) /
                 static_cast<double>(std::accumulate(gates.begin(), gates.end(), std::int64_t{0}));
    taken.volume.sweeps = {volume.sweeps[static_cast<std::size_t>(most - gates.begin())]};
    std::erase_if(taken.volume.sweeps.front().moments, [](const level2::SweepMoment& kind) {
        return kind.moment != level2::Moment::vel;
    });
    return taken;
}

// Returns the choice that dealias() makes without a budget.
accuracy::Choice usual_choice(const accuracy::Step& step) {
    const accuracy::RungRange allowed = accuracy::allowed_rungs(step);
    const bool is_needed =
        !step.effects.empty() && accuracy::is_unbounded(step.effects[0].predicted);
    return {{is_needed ? allowed.most : allowed.least}};
}

}  // namespace

accuracy::Chain dealiasing_chain(Dealiasing asked) {
    accuracy::Chain chain;
    chain.steps = {make_ladder()};
    chain.value_unit = accuracy::ValueUnit::mps;
    if (asked == Dealiasing::automatic) return chain;
    const auto rung = static_cast<std::size_t>(std::ranges::find(ladder, asked) - ladder.begin());
    std::vector<accuracy::Effect>& effects = chain.steps.front().effects;
    for (std::size_t i = 0; i < effects.size(); ++i)
        effects[i].setting = i < rung ? Setting::on : Setting::off;
    return chain;
}

void predict_dealiasing(const level2::Volume& volume, accuracy::Chain& chain) {
    if (!needs_dealiasing(volume)) return;
    const std::vector<VelocitySheet> sheets = velocity_sheets(volume);
    const double turn_mps =
        std::ranges::max_element(sheets, {}, &VelocitySheet::turn_mps)->turn_mps;
    const TimedSweep timed = take_sweep(volume, sheets);
    double time_below_s = 0;
    std::vector<accuracy::Effect>& effects = chain.steps.front().effects;
    for (std::size_t i = 0; i < effects.size(); ++i) {
        const bool is_first = i == 0;
        effects[i].predicted.value = is_first ? std::numeric_limits<double>::infinity() : turn_mps;
        Stopwatch watch;
        (void)dealias(timed.volume, ladder[i + 1]);
        const double time_s = watch.lap_s() / timed.part;
        effects[i].cost_s = std::max(0.0, time_s - time_below_s);
        time_below_s = std::max(time_s, time_below_s);
    }
}

Result<DealiasingPlan> plan_dealiasing(const level2::Volume& volume, Dealiasing asked,
                                       const std::optional<accuracy::Budget>& budget) {
    accuracy::Chain chain = dealiasing_chain(asked);
    predict_dealiasing(volume, chain);
    DealiasingPlan made;
    if (budget) {
        auto planned = accuracy::plan(chain, *budget);
        if (!planned) return pass_on(planned);
        made.plan = std::move(*planned);
    } else {
        made.plan = accuracy::plan_of_default(chain, usual_choice(chain.steps.front()));
    }
    const std::size_t rung = made.plan.choice.rungs.front();
    if (rung > 0) made.rung = ladder[rung];
    return made;
}

}  // namespace stormcellar::retrieve
