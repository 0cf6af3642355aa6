// render/plan/volume_plan.h -- the cheapest picture of a volume that holds a budget, and how large
// each effect is in it.
//
// Sizes are the 99th percentile of CIEDE2000 over all pixels of the picture, without labels and
// over the page's colour: each rung against the one below, every other step exact. What is measured
// is the whole picture against the exact chain's, so that nothing is estimated; the price is that
// picture, drawn once.
// Threads: a VolumeScene is used by one thread at a time; it draws on `threads`.
#pragma once

#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "render/plan/volume_effects.h"
#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/accuracy/plan.h"
#include "stormcellar/base/result.h"

namespace stormcellar::render {

// What is to be drawn; all must outlive it.
class VolumeScene {
  public:
    // `width` and `height` are those of the picture without its labels.
    VolumeScene(const grid::BrickView& view, const ColourTable& table, const Scene& scene,
                int width, int height, int threads);

    struct Drawn {
        Image picture;
        double seconds = 0;  // by the clock, with what a loop makes once
    };
    // Drawn once and kept.
    [[nodiscard]] const Drawn& draw(const VolumeChoice& choice);

  private:
    grid::BrickView view_;
    const ColourTable& table_;
    Scene scene_;
    int width_, height_, threads_;
    std::deque<std::pair<VolumeChoice, Drawn>> drawn_;  // references to them stay
};

// Of what the scene does not ask for, a size is told to who wants to know all; no plan needs it.
enum class Predicted { asked, all };

// Each effect's size and cost for this scene; settings stay.
[[nodiscard]] Status predict(VolumeScene& scene, accuracy::Chain& chain,
                             Predicted which = Predicted::asked);

struct VolumePlan {
    accuracy::Plan plan;
    VolumeChoice choice;
};
// Predicts, chooses and measures (accuracy/governor.h). Without a budget: what `by_default` names,
// with each effect's size. Errors: those of accuracy::govern(); bad_argument for a budget that
// bounds other errors than the picture's.
[[nodiscard]] Result<VolumePlan> plan_volume(VolumeScene& scene, accuracy::Chain chain,
                                             const std::optional<accuracy::Budget>& budget,
                                             const VolumeChoice& by_default,
                                             Predicted which = Predicted::asked);

// A row for each rung of each step that the scene asks for, the others exact, against the exact
// chain's picture.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(VolumeScene& scene,
                                                                  const accuracy::Chain& chain);

}  // namespace stormcellar::render
