// pipeline/mosaic/mosaic_scene.h -- volumes of several sites over one domain, made into the frame
// of one instant in any way, whole: what the accuracy planner measures mosaics on (mosaic_plan.h).
//
// The instant brackets some of the volumes; only those are gridded again, each way of gridding
// once: the two that were used last are kept. The motion of echo is estimated once, from the
// default grids, and is that of every frame: a rung errs by what it does, not by another motion.
// Threads: use a scene from one thread; it starts up to `threads` of its own.
#pragma once

#include <list>
#include <string>
#include <vector>

#include "pipeline/mosaic/mosaic_effects.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/refractivity.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

// One volume of a site and what its partials say of where they come from.
struct SceneVolume {
    const level2::Volume* volume = nullptr;
    grid::SitePosition site;
    std::string file;  // as errors name it; its last part goes into the provenance
    bool partial = false;
    std::vector<std::string> notes;
};

// Each on its site's window of the domain, in their order. Errors name the file: those of
// make_partial(); bad_argument for a site that sees nothing of the domain.
[[nodiscard]] Result<std::vector<MadePartial>> make_partials(std::span<const SceneVolume> volumes,
                                                             const grid::GridSpec& domain,
                                                             const PartialOptions& options,
                                                             GeometryCache& geometries);

[[nodiscard]] std::vector<PartialView> views_of(const std::vector<MadePartial>& partials);

// The instant that a mosaic of these is of: the middle between the earliest and the latest of the
// sites' newest partials, by their middles. Where these do not all lie within `greatest_gap` of it,
// the newest one's middle: what is far apart in time does not blend.
[[nodiscard]] UtcTime instant_of_newest(
    std::span<const PartialView> partials,
    std::chrono::milliseconds greatest_gap = FrameOptions{}.greatest_gap);

struct MosaicSceneOptions {
    FrameOptions frame;      // time, sweeps and motions are the choice's and the scene's own
    PartialOptions partial;  // likewise method, frame and quantisation
    // None: instant_of_newest().
    std::optional<UtcTime> instant = std::nullopt;
};

class MosaicScene {
  public:
    // Of a volume's first radial and of its last.
    struct Times {
        UtcTime start, end;
    };

    // Grids all volumes the default way. The volumes must outlive the scene.
    // Errors: those of make_partials(), not_found when no volume is near the instant.
    [[nodiscard]] static Result<MosaicScene> make(std::vector<SceneVolume> volumes,
                                                  const grid::GridSpec& domain,
                                                  const accuracy::Chain& chain,
                                                  const MosaicSceneOptions& options);

    // The same bits whenever it is asked for.
    [[nodiscard]] Result<MosaicFrame> frame(const MosaicChoice& choice);
    // Partials of the volumes in use, gridded and kept as the choice has it.
    [[nodiscard]] Result<const std::vector<MadePartial>*> partials(const MosaicChoice& choice);

    // What was kept of this choice's gridding, so that it is made anew.
    void forget(const MosaicChoice& choice);

    // Those that the instant brackets.
    [[nodiscard]] const std::vector<SceneVolume>& volumes() const { return volumes_; }
    [[nodiscard]] const std::vector<Times>& times() const { return times_; }
    // Of them, by place; pairs are what time is interpolated between.
    [[nodiscard]] const std::vector<Bracket>& brackets() const { return brackets_; }
    [[nodiscard]] std::size_t pair_count() const;
    [[nodiscard]] const Motions& motions() const { return motions_; }
    // That estimating them took: of one thread by the processor's time, of several by the clock.
    [[nodiscard]] double motion_seconds() const { return motion_s_; }
    [[nodiscard]] double now_s() const;
    [[nodiscard]] const grid::GridSpec& domain() const { return domain_; }
    [[nodiscard]] UtcTime instant() const { return instant_; }
    [[nodiscard]] const MosaicSceneOptions& options() const { return options_; }
    [[nodiscard]] const MosaicChoice& default_choice() const { return default_; }

  private:
    struct Kept {
        grid::SceneChoice gridding;
        bool fine_codes = false;
        std::vector<MadePartial> partials;
    };

    MosaicScene() = default;
    [[nodiscard]] Status keep_what_is_near(std::vector<SceneVolume> volumes,
                                           std::vector<MadePartial> partials);

    std::vector<SceneVolume> volumes_;
    std::vector<Times> times_;
    grid::GridSpec domain_;
    MosaicSceneOptions options_;
    MosaicChoice default_;
    UtcTime instant_;
    std::vector<Bracket> brackets_;
    Motions motions_;
    double motion_s_ = 0;
    std::list<Kept> kept_;  // used last first
    std::shared_ptr<GeometryCache> geometries_;
};

}  // namespace stormcellar::pipeline
