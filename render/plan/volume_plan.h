// render/plan/volume_plan.h -- finds the cheapest picture of a volume within a budget, and the size
// of each effect in it.
//
// A size is the 99th percentile of CIEDE2000 over all pixels of the picture, drawn without labels
// over the page's color. The size compares a rung with the rung below; all other steps are exact.
// The planned picture is compared with the picture of the exact chain, so nothing is estimated. But
// the exact picture must be drawn once.
//
// Threads   One thread at a time may use a VolumeScene. It draws with `threads` threads.
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

// A scene that is drawn by several choices. All arguments must outlive the VolumeScene.
class VolumeScene {
  public:
    // `width` and `height` are the size of the picture without its labels.
    VolumeScene(const grid::BrickView& view, const ColorTable& table, const Scene& scene, int width,
                int height, int threads);

    struct Drawn {
        Image picture;
        double seconds = 0;  // by the clock; includes work that a loop does only once
    };
    // Draws the picture of a choice and keeps it. Later calls return the kept picture.
    [[nodiscard]] const Drawn& draw(const VolumeChoice& choice);

  private:
    grid::BrickView view_;
    const ColorTable& table_;
    Scene scene_;
    int width_, height_, threads_;
    std::deque<std::pair<VolumeChoice, Drawn>> drawn_;  // a deque, so that references stay valid
};

// The effects to predict: those that the scene asks for, which are enough for a plan, or all.
enum class Predicted { asked, all };

// Predicts the size and cost of each effect for this scene. Does not change settings.
[[nodiscard]] Status predict(VolumeScene& scene, accuracy::Chain& chain,
                             Predicted which = Predicted::asked);

struct VolumePlan {
    accuracy::Plan plan;
    VolumeChoice choice;
};
// Predicts, chooses and measures (accuracy/governor.h). Without a budget, the plan has the choice
// `by_default`, with the size of each effect. Errors: those of accuracy::govern(); bad_argument for
// a budget that bounds anything but a color difference or a time.
[[nodiscard]] Result<VolumePlan> plan_volume(VolumeScene& scene, accuracy::Chain chain,
                                             const std::optional<accuracy::Budget>& budget,
                                             const VolumeChoice& by_default,
                                             Predicted which = Predicted::asked);

// Makes a row for each rung of each step that the scene asks for. The row compares two pictures:
// one is drawn with this rung and exactly in all other steps; the other is drawn by the exact
// chain.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> run_ladder(VolumeScene& scene,
                                                                  const accuracy::Chain& chain);

}  // namespace stormcellar::render
