// pipeline/mosaic/mosaic_maker.h -- keeps the mosaics of configured domains fresh as volumes come.
//
// A volume of a site that a domain takes is gridded on the domain's columns and kept in the store
// as the domain "NAME.ICAO"; then the frames of "NAME" that it changes are made again: those
// between the site's volume before and the one after. Of a frame that stands, only the bricks are
// merged that the sites touch whose partials have changed since (pipeline/mosaic/frame_parts.h); to
// the byte it is as if it were made whole. Frames stand at whole multiples of the interval since
// midnight UTC, none before the oldest volume thereabouts or after the newest. A frame is
// provisional until each of its sites has a volume after it (or for 15 minutes had none), and has a
// revision that counts how often it was replaced.
//
// What a frame is made of is verified first, and so is the frame that is copied from. A partial
// that cannot be read, or is damaged, is left out of frames, and named. Errors: those of gridding,
// merging and the store.
//
// Thread contract: may be used by many threads; those of one domain and moment wait for each other.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/keep/geometry_cache.h"
#include "pipeline/mosaic/domain_frames.h"
#include "pipeline/mosaic/instant_cache.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

// A volume and where it comes from.
struct VolumeSource {
    const level2::Volume& volume;
    const grid::SitePosition& site;
    std::string file;  // its name, without directories
    std::int64_t modified_ns = 0;
    bool partial = false;
    std::vector<std::string> notes = {};
    std::vector<std::string> radar_troubles = {};  // as in grid::Provenance
};

struct Kept {
    std::vector<std::filesystem::path> partials, frames;
    std::size_t updated = 0;            // frames of which bricks that had not changed were copied
    std::vector<std::string> problems;  // what was left out, and why
};

// A frame that was made and stands now.
struct FrameMade {
    std::filesystem::path path;                           // empty: older than what the budgets keep
    std::vector<std::string> stations;                    // whose partials it is made of
    std::optional<std::vector<grid::GridWindow>> merged;  // as MosaicFrame has it
};

class MappedPartials;

class MosaicMaker {
  public:
    // Without a store, or without domains, it does nothing.
    MosaicMaker(cache::StoreWriter* store, std::vector<Domain> domains,
                FramesWhen frames = FramesWhen::volume_comes);

    // Does nothing for volumes that no domain takes. `threads` work on it. Errors: what may pass,
    // as when the system refuses a write; all other domains have the volume then all the same.
    Result<Kept> take_in(const VolumeSource& source, int threads);
    [[nodiscard]] bool is_idle() const { return store_ == nullptr || domains_.empty(); }
    [[nodiscard]] const std::vector<Domain>& domains() const { return domains_; }
    // As find_domain() says, among these domains.
    [[nodiscard]] const Domain* find(std::string_view name, level2::Moment moment) const {
        return find_domain(domains_, name, moment);
    }

    // Makes a frame from the partials that stand, and puts it in the place of what stands there.
    // `problems` names partials that are left out. Errors: not_found when the domain is not
    // configured, or no site has a volume near the instant; bad_argument for an instant at which
    // the domain has no frames.
    Result<FrameMade> make_again(const cache::GridName& frame, int threads,
                                 std::vector<std::string>& problems);

  private:
    struct FrameJob {
        const Domain& domain;
        level2::Moment moment;
        UtcTime instant;
        int threads;
    };
    std::mutex& frames_of(const std::string& domain, level2::Moment moment);
    Result<MosaicFrame> frame_of_sound(const FrameJob& job, MappedPartials& partials,
                                       const PreviousFrame* previous,
                                       std::vector<std::string>& problems);
    // The mutex of the domain's frames must be held.
    Result<FrameMade> make(const FrameJob& job, MappedPartials& partials,
                           std::vector<std::string>& problems);
    Status keep(const Domain& domain, level2::Moment moment, const VolumeSource& source,
                int threads, Kept& kept);
    Status refresh(const Domain& domain, level2::Moment moment,
                   const cache::GridDescription& changed, int threads, Kept& kept);

    cache::StoreWriter* store_;
    std::vector<Domain> domains_;
    FramesWhen frames_when_;
    GeometryCache geometries_;
    InstantCache instants_;
    std::mutex mutex_;                                                     // guards frames_
    std::map<std::pair<std::string, level2::Moment>, std::mutex> frames_;  // one at a time each
};

}  // namespace stormcellar::pipeline
