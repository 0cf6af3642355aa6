// pipeline/mosaic/mosaic_scene.h -- makes the frame of one instant from volumes of several sites
// over one domain, by any choice, so that the accuracy planner can measure frames
// (pipeline/plan/mosaic_plan.h).
//
// Only the volumes next to the instant are used. They are gridded once for each choice of gridding,
// and the results of the last two choices are kept. The motion of echo is estimated once, from the
// default grids, and used for every frame, so that a rung's error contains no error of motion.
//
// Threads   One thread at a time; a scene starts up to `threads` threads of its own.
#pragma once

#include <string>
#include <vector>

#include "base/recently_used.h"
#include "pipeline/mosaic/mosaic_effects.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/refractivity.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

// One volume of a site, and facts about its raw file.
struct SceneVolume {
    const level2::Volume* volume = nullptr;
    grid::SitePosition site;
    std::string file;  // the name for errors; its last part goes into the provenance
    bool partial = false;
    std::vector<std::string> notes;
};

// Makes the partials of the volumes, in order, each on its site's window of the domain. Errors name
// the file: those of make_partial(); bad_argument for a site that sees nothing of the domain.
[[nodiscard]] Result<std::vector<MadePartial>> make_partials(std::span<const SceneVolume> volumes,
                                                             const grid::GridSpec& domain,
                                                             const PartialOptions& options,
                                                             GeometryCache& geometries);

[[nodiscard]] std::vector<PartialView> views_of(const std::vector<MadePartial>& partials);

// Returns the instant for a mosaic of these partials: the middle between the earliest and the
// latest of the sites' newest partials, by their middles. If that instant is more than
// `greatest_gap` from these two, returns the middle of the newest partial, because volumes far
// apart in time cannot be blended.
[[nodiscard]] UtcTime instant_of_newest(
    std::span<const PartialView> partials,
    std::chrono::milliseconds greatest_gap = FrameOptions{}.greatest_gap);

struct MosaicSceneOptions {
    FrameOptions frame;      // time, sweeps and motions are set by the choice and the scene
    PartialOptions partial;  // likewise method, frame and quantization
    std::optional<UtcTime> instant = std::nullopt;  // none: instant_of_newest()
};

class MosaicScene {
  public:
    // The times of a volume's first and last radial.
    struct Times {
        UtcTime start, end;
    };

    // Grids all volumes by the default method. The volumes must outlive the scene. Errors: those of
    // make_partials(); bad_argument if there are no volumes; not_found if no volume is near the
    // instant.
    [[nodiscard]] static Result<MosaicScene> make(std::vector<SceneVolume> volumes,
                                                  const grid::GridSpec& domain,
                                                  const accuracy::Chain& chain,
                                                  const MosaicSceneOptions& options);

    // Returns the frame of a choice, with the same bytes each time.
    [[nodiscard]] Result<MosaicFrame> frame(const MosaicChoice& choice);
    // Returns the partials of the volumes in use, gridded and quantized by the choice.
    [[nodiscard]] Result<const std::vector<MadePartial>*> partials(const MosaicChoice& choice);

    // Forgets the kept partials of this choice's gridding, so that they are made anew.
    void forget(const MosaicChoice& choice);

    // Returns the volumes next to the instant, which the frames use.
    [[nodiscard]] const std::vector<SceneVolume>& volumes() const { return volumes_; }
    [[nodiscard]] const std::vector<Times>& times() const { return times_; }
    // Returns the brackets of the sites, as indexes into volumes(). A pair is a bracket with both
    // volumes.
    [[nodiscard]] const std::vector<Bracket>& brackets() const { return brackets_; }
    [[nodiscard]] std::size_t pair_count() const;
    [[nodiscard]] const Motions& motions() const { return motions_; }
    // Returns the time for estimating the motions: processor time for one thread, wall time for
    // several.
    [[nodiscard]] double motion_seconds() const { return motion_s_; }
    [[nodiscard]] double now_s() const;
    [[nodiscard]] const grid::GridSpec& domain() const { return domain_; }
    [[nodiscard]] UtcTime instant() const { return instant_; }
    [[nodiscard]] const MosaicSceneOptions& options() const { return options_; }
    [[nodiscard]] const MosaicChoice& default_choice() const { return default_; }

  private:
    // The choices on which partials depend.
    struct Gridding {
        grid::SceneChoice choice;
        bool fine_codes = false;
        bool operator==(const Gridding&) const = default;
    };
    static constexpr std::size_t most_kept = 2;

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
    RecentlyUsed<Gridding, std::vector<MadePartial>> kept_{{.values = most_kept}};
    std::shared_ptr<GeometryCache> geometries_;
};

}  // namespace stormcellar::pipeline
