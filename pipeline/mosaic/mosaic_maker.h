// pipeline/mosaic/mosaic_maker.h -- keeps the mosaics of configured domains up to date as volumes
// come.
//
// A volume of a site that a domain uses is gridded on the domain's columns. This partial is kept in
// the store, in the domain "NAME.ICAO". Then the frames of "NAME" from the site's previous volume
// to its next one are made again. Only bricks that sites with changed partials touch are merged
// again (pipeline/mosaic/frame_parts.h); the bytes are the same as if all bricks were merged.
// Frames are at whole multiples of the interval since midnight UTC, from the middle of the oldest
// partial nearby to the middle of the newest. A frame is provisional until each of its sites has a
// volume after it, or has had none for 15 minutes. The revision of a frame is the number of its
// partials. The bytes of a frame depend only on its partials and on late machines, however often it
// is made.
//
// The partials of a frame, and the earlier frame from which bricks are copied, are verified before
// use. A partial that cannot be read or is damaged is left out of frames, and the problems name it.
//
// The process may end, or a disk may fail, after a partial was stored and before its frames were
// made. Then the frames lack the partial. So if another machine brings a partial that the store
// already has, the frames around it are checked (make_stale()).
//
// A frame leaves out the stations of late machines (pipeline/options/partial_sources.h). Its
// provenance names these stations.
//
// Threads   Many threads may use one MosaicMaker; calls for the same domain and moment wait for
//           each other.
// Errors    Those of gridding, merging and the store.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/keep/geometry_cache.h"
#include "pipeline/mosaic/domain_frames.h"
#include "pipeline/mosaic/instant_cache.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "pipeline/options/domain.h"
#include "pipeline/options/partial_sources.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

// A volume and its source.
struct VolumeSource {
    const level2::Volume& volume;
    const grid::SitePosition& site;
    std::string file;  // the file's name, without directories
    bool partial = false;
    bool has_rival = false;  // as in pipeline/keep/keep_rule.h
    std::vector<std::string> notes = {};
    std::vector<std::string> radar_troubles = {};  // as in grid::Provenance
};

// A partial that another machine made.
struct OthersPartial {
    std::filesystem::path file;  // may be replaced, but is never changed
    cache::GridName name;
    std::string machine;
    std::function<void()> beat = {};  // called before each frame is made
};

struct Kept {
    std::vector<std::filesystem::path> partials, frames;
    std::size_t updated = 0;            // frames that reused bricks which had not changed
    std::vector<std::string> problems;  // partials, domains and frames that were left out, and why
    // Set if the cache had another partial of the same volume and both volumes are complete. True
    // if this partial replaced the other, else false.
    std::optional<bool> won = {};
};

// A frame that was made and now exists.
struct FrameMade {
    std::filesystem::path path;         // empty: the cache's budgets do not keep the frame
    std::vector<std::string> stations;  // stations of its partials
    std::optional<std::vector<grid::GridWindow>> merged;  // as in MosaicFrame
};

// A frame that make_stale() checked.
struct StaleFrame {
    cache::GridName name;
    std::optional<FrameMade> made;  // none: the frame was current, or is not due
};

class MappedPartials;

class MosaicMaker {
  public:
    // Makes an object that does nothing if `store` is null or `domains` is empty.
    MosaicMaker(cache::StoreWriter* store, std::vector<Domain> domains,
                FramesWhen frames = FramesWhen::volume_comes,
                std::shared_ptr<PartialSources> sources = nullptr);

    // Makes the partials of a volume, and the frames that they change, with `threads` threads. Does
    // nothing if no domain uses the volume. Errors: only temporary ones, for example if the system
    // refuses a write; the volume is still stored for the other domains. Lasting errors are among
    // the problems.
    Result<Kept> take_in(const VolumeSource& source, int threads);
    // Copies a partial that another machine made into the store, and makes the frames that it
    // changes. If the store has the partial already, only notes its frames for make_stale(). If the
    // store keeps another grid of the volume, makes nothing. Errors: those of the file (corrupt,
    // truncated and others); bad_argument if no domain has such a partial, its columns or codes are
    // not the domain's, or its radials are in the future; those of the store. If a frame can never
    // be made, the problems name it, and the partial is accepted.
    Result<Kept> take_partial(const OthersPartial& partial, int threads);
    // If the store already had a partial when take_partial() was called, the frames around it must
    // be checked. Checks the newest of these frames that is not checked yet. Makes the frame again
    // if it lacks one of its partials or was made from an earlier state of them. Returns none when
    // all were checked. Errors: those of make_again(); the frame is checked again later unless the
    // error is in the data.
    Result<std::optional<StaleFrame>> make_stale(int threads, std::vector<std::string>& problems);
    [[nodiscard]] bool is_idle() const { return store_ == nullptr || domains_.empty(); }
    [[nodiscard]] const std::vector<Domain>& domains() const { return domains_; }
    // Calls find_domain() for these domains.
    [[nodiscard]] const Domain* find(std::string_view name, level2::Moment moment) const {
        return find_domain(domains_, name, moment);
    }

    // Makes a frame from the existing partials. It replaces the existing frame. Names in `problems`
    // the partials that are left out. Errors: not_found if the domain is not configured, or no site
    // has a volume near the instant; bad_argument for an instant at which the domain has no frames.
    Result<FrameMade> make_again(const cache::GridName& frame, int threads,
                                 std::vector<std::string>& problems);

  private:
    struct FrameJob {
        const Domain& domain;
        level2::Moment moment;
        UtcTime instant;
        int threads;
    };
    // Returns the mutex for the frames of a domain and moment, because these are made one at a
    // time.
    Mutex& frames_of(const std::string& domain, level2::Moment moment);
    Result<MosaicFrame> frame_of_sound(const FrameJob& job, MappedPartials& partials,
                                       const std::vector<LateMachine>& late,
                                       const PreviousFrame* previous,
                                       std::vector<std::string>& problems);
    Result<FrameMade> make(const FrameJob& job, MappedPartials& partials,
                           std::vector<std::string>& problems, Mutex& frames)
        STORMCELLAR_REQUIRES(frames);
    Status keep(const Domain& domain, level2::Moment moment, const VolumeSource& source,
                int threads, Kept& kept);
    Status refresh(const Domain& domain, level2::Moment moment,
                   const cache::GridDescription& changed, int threads, Kept& kept, Mutex& frames,
                   const std::function<void()>& beat = {}) STORMCELLAR_REQUIRES(frames);
    void finish(cache::GridDescription& frame, const std::vector<LateMachine>& late) const;
    [[nodiscard]] std::vector<LateMachine> late_for(const FrameJob& job) const;
    [[nodiscard]] Result<bool> is_stale(const FrameJob& job, const MappedPartials& partials) const;
    // Notes that make_stale() must check the frames around a partial.
    void note_frames(const Domain& domain, const OthersPartial& partial, UtcTime middle);

    cache::StoreWriter* store_;
    std::vector<Domain> domains_;
    FramesWhen frames_when_;
    std::shared_ptr<PartialSources> sources_;
    GeometryCache geometries_;
    InstantCache instants_;
    struct Newest {
        bool operator()(const cache::GridName& a, const cache::GridName& b) const {
            return a.time != b.time ? a.time > b.time : a < b;
        }
    };
    Mutex mutex_;
    // The frames that make_stale() must check.
    std::set<cache::GridName, Newest> unchecked_ STORMCELLAR_GUARDED_BY(mutex_);
    std::map<std::pair<std::string, level2::Moment>, Mutex> frames_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::pipeline
