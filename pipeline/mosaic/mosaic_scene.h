// pipeline/mosaic/mosaic_scene.h -- makes the frame of one instant from volumes of several sites in
// any chain: the accuracy planner measures mosaics on it (mosaic_plan.h).
//
// Only the volumes that bracket the instant are gridded, once for each way of gridding; the two
// ways that were used last are cached. The motion of echo is estimated once, from the default
// grids, and is used for every frame: the error of a rung then comes from the rung, not from
// another motion. Thread contract: use a scene from one thread; it starts up to `threads` of its
// own.
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

// One volume of a site, and what its partials say about their source.
struct SceneVolume {
    const level2::Volume* volume = nullptr;
    grid::SitePosition site;
    std::string file;  // the name for errors; its last part goes into the provenance
    bool partial = false;
    std::vector<std::string> notes;
};

// Makes each partial on its site's window of the domain, in the order of the volumes. Errors name
// the file: those of make_partial(); bad_argument for a site that sees nothing of the domain.
[[nodiscard]] Result<std::vector<MadePartial>> make_partials(std::span<const SceneVolume> volumes,
                                                             const grid::GridSpec& domain,
                                                             const PartialOptions& options,
                                                             GeometryCache& geometries);

[[nodiscard]] std::vector<PartialView> views_of(const std::vector<MadePartial>& partials);

// The instant of the mosaic of these volumes: the middle between the earliest and the latest of the
// sites' newest partials, by their middles. If these are not all within `greatest_gap` of it, the
// middle of the newest: partials that are far apart in time are not blended.
[[nodiscard]] UtcTime instant_of_newest(
    std::span<const PartialView> partials,
    std::chrono::milliseconds greatest_gap = FrameOptions{}.greatest_gap);

struct MosaicSceneOptions {
    FrameOptions frame;      // time, sweeps and motions come from the choice and the scene
    PartialOptions partial;  // method, frame and quantization do too
    // None: instant_of_newest().
    std::optional<UtcTime> instant = std::nullopt;
};

class MosaicScene {
  public:
    // The time of a volume's first radial, and of its last.
    struct Times {
        UtcTime start, end;
    };

    // Grids all volumes in the default way. The volumes must outlive the scene. Errors: those of
    // make_partials(); not_found if no volume is near the instant.
    [[nodiscard]] static Result<MosaicScene> make(std::vector<SceneVolume> volumes,
                                                  const grid::GridSpec& domain,
                                                  const accuracy::Chain& chain,
                                                  const MosaicSceneOptions& options);

    // Returns the same bits every time.
    [[nodiscard]] Result<MosaicFrame> frame(const MosaicChoice& choice);
    // Partials of the volumes in use, gridded and stored as the choice says.
    [[nodiscard]] Result<const std::vector<MadePartial>*> partials(const MosaicChoice& choice);

    // Drops what is cached for the gridding of this choice, so that it is made anew.
    void forget(const MosaicChoice& choice);

    // The volumes that bracket the instant.
    [[nodiscard]] const std::vector<SceneVolume>& volumes() const { return volumes_; }
    [[nodiscard]] const std::vector<Times>& times() const { return times_; }
    // For these volumes, by their index: the pairs between which time is interpolated.
    [[nodiscard]] const std::vector<Bracket>& brackets() const { return brackets_; }
    [[nodiscard]] std::size_t pair_count() const;
    [[nodiscard]] const Motions& motions() const { return motions_; }
    // How long estimating the motions took: by processor time with one thread, by the clock with
    // more.
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
    std::list<Kept> kept_;  // the one used last is first
    std::shared_ptr<GeometryCache> geometries_;
};

}  // namespace stormcellar::pipeline
