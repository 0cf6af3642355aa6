// retrieve/plan/dealiasing_plan.h -- the ladder of dealiasing for the planner: what each rung costs
// on a volume, and how much it changes the velocities.
//
// Need      If needs_dealiasing() finds no need, all sizes are 0, so the plan leaves all rungs off.
// Sizes     Otherwise the effect of the first rung has no bound, because folded velocities may be
//           off by any number of turns. Each further rung corrects gates that are off by a turn
//           (twice the greatest Nyquist velocity of the volume) or more, so a turn is the size of
//           the rung: the plan leaves the rung off only if the budget allows errors of a turn.
// Times     The rungs are timed on the sweep with the most velocities, and the time is scaled to
//           the velocities of the volume. A rung counts at least the time of the rung below,
//           although `region` can be faster than `profile`.
// Units     m/s and seconds.
// Accuracy  Sizes do not bound the error of single gates; most gates have no error
//           (docs/velocity.md, the ladder). No test checks the times, which depend on a clock.
// Threads   Pure functions.
#pragma once

#include <optional>

#include "stormcellar/accuracy/plan.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

// Returns a chain of one step, "dealiasing". `asked` sets its effects on or off; `automatic` leaves
// them to the planner.
[[nodiscard]] accuracy::Chain dealiasing_chain(Dealiasing asked);

// Fills in sizes and times for a volume.
void predict_dealiasing(const level2::Volume& volume, accuracy::Chain& chain);

struct DealiasingPlan {
    accuracy::Plan plan;
    Dealiasing rung = Dealiasing::automatic;  // for dealias(); `automatic` if all rungs are off
};

// Plans for a volume. Without a budget, the plan has the rung that dealias() would use. Errors:
// those of accuracy::plan().
[[nodiscard]] Result<DealiasingPlan> plan_dealiasing(const level2::Volume& volume, Dealiasing asked,
                                                     const std::optional<accuracy::Budget>& budget);

}  // namespace stormcellar::retrieve
