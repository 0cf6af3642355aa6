// pipeline/mosaic/mosaic_scene.h -- makes the frame of one instant from volumes of several sites
// over one domain, by any choice. The accuracy planner measures frames with it
// (pipeline/plan/mosaic_plan.h).
//
// Only the volumes next to the instant are used. They are gridded once for each choice of gridding;
// the results of the last two choices are kept. The motion of the echo is estimated once, from the
// default grids, and is used for every frame. So the error of a rung contains no error of motion.
//
// Threads   One thread at a time. A scene starts up to `threads` threads of its own.
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

// A volume of a site, with facts about its raw file.
struct SceneVolume {
    const level2::Volume* volume = nullptr;
    grid::SitePosition site;
    std::string file;  // name in errors; its last part goes into the provenance
    bool partial = false;
    std::vector<std::string> notes;
};

// Makes the partials of the volumes, in order, each on the window of its site. Errors name the
// file: those of make_partial(); bad_argument for a site that sees nothing of the domain.
[[nodiscard]] Result<std::vector<MadePartial>> make_partials(std::span<const SceneVolume> volumes,
                                                             const grid::GridSpec& domain,
                                                             const PartialOptions& options,
                                                             GeometryCache& geometries);

[[nodiscard]] std::vector<PartialView> views_of(const std::vector<MadePartial>& partials);

// Returns the instant for a mosaic of these partials. Take the middles of the sites' newest
// partials: the instant is half way between the earliest and the latest of these. If that is more
// than `greatest_gap` from both, returns the latest, because volumes that far apart cannot be
// blended.
[[nodiscard]] UtcTime instant_of_newest(
    std::span<const PartialView> partials,
    std::chrono::milliseconds greatest_gap = FrameOptions{}.greatest_gap);

struct MosaicSceneOptions {
    FrameOptions frame;      // the choice and the scene set its time, sweeps and motions
    PartialOptions partial;  // the choice sets its method, frame and quantization
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

    // Returns the frame of a choice. It has the same bytes each time.
    [[nodiscard]] Result<MosaicFrame> frame(const MosaicChoice& choice);
    // Returns the partials of the volumes that are used. The choice decides how they are gridded
    // and quantized.
    [[nodiscard]] Result<const std::vector<MadePartial>*> partials(const MosaicChoice& choice);

    // Forgets the partials that are kept for the gridding of this choice. They are made anew when
    // needed.
    void forget(const MosaicChoice& choice);

    // Returns the volumes that the frames use: the volumes next to the instant.
    [[nodiscard]] const std::vector<SceneVolume>& volumes() const { return volumes_; }
    [[nodiscard]] const std::vector<Times>& times() const { return times_; }
    // Returns the brackets of the sites, as indices into volumes(). A bracket that has both volumes
    // is a pair.
    [[nodiscard]] const std::vector<Bracket>& brackets() const { return brackets_; }
    [[nodiscard]] std::size_t pair_count() const;
    [[nodiscard]] const Motions& motions() const { return motions_; }
    // Returns how long it took to estimate the motions. The time is processor time for one thread,
    // and wall time for several.
    [[nodiscard]] double motion_seconds() const { return motion_s_; }
    [[nodiscard]] double now_s() const;
    [[nodiscard]] const grid::GridSpec& domain() const { return domain_; }
    [[nodiscard]] UtcTime instant() const { return instant_; }
    [[nodiscard]] const MosaicSceneOptions& options() const { return options_; }
    [[nodiscard]] const MosaicChoice& default_choice() const { return default_; }

  private:
    // The choices that affect partials.
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
