// pipeline/mosaic/mosaic_maker.h -- updates the mosaics of configured domains as volumes come.
//
// A volume of a site that a domain uses is gridded on the domain's columns, and stored as the
// domain "NAME.ICAO". Then the frames of "NAME" that the volume changes are made again: those
// between the site's volume before it and the one after it. If a frame exists, only the bricks are
// merged that belong to sites whose partials have changed since (pipeline/mosaic/frame_parts.h);
// the result has the same bytes as a frame that is merged completely. Frames are made for whole
// multiples of the interval since midnight UTC, none before the oldest volume thereabouts or after
// the newest. A frame is provisional until each of its sites has a volume after it (or had none for
// 15 minutes). Its revision counts how often it was replaced.
//
// The partials of a frame are verified first, and so is a frame from which bricks are copied. A
// partial that cannot be read, or is damaged, is left out of frames and reported. Errors: those of
// gridding, merging and the store.
//
// Thread contract: many threads may use it; threads for the same domain and moment wait for each
// other.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/keep/geometry_cache.h"
#include "pipeline/mosaic/instant_cache.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "pipeline/options/domain.h"
#include "pipeline/options/frames_when.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

// A volume and where it comes from.
struct VolumeSource {
    const level2::Volume& volume;
    const grid::SitePosition& site;
    std::string file;  // the file's name, without directories
    std::int64_t modified_ns = 0;
    bool partial = false;
    std::vector<std::string> notes = {};
    std::vector<std::string> radar_troubles = {};  // as in grid::Provenance
};

struct Kept {
    std::vector<std::filesystem::path> partials, frames;
    std::size_t updated = 0;            // frames in which unchanged bricks were copied
    std::vector<std::string> problems;  // what was left out, and why
};

// A frame that was made and is in the cache.
struct FrameMade {
    std::filesystem::path path;         // empty: it is older than all that the limits keep
    std::vector<std::string> stations;  // of the partials that the frame is made of
    std::optional<std::vector<grid::GridWindow>> merged;  // as MosaicFrame has it
};

// How the frames of a domain are made.
[[nodiscard]] FrameOptions frame_options(const Domain& domain, level2::Moment moment, int threads);

// From the first to the last, both included: whole multiples of the interval since midnight UTC.
[[nodiscard]] std::vector<UtcTime> instants_between(UtcTime from, UtcTime to,
                                                    std::chrono::seconds interval);

// No frame is made between volumes of a site that are further apart.
inline constexpr std::chrono::milliseconds greatest_frame_gap = FrameOptions{}.greatest_gap;

enum class FrameStanding {
    not_due,  // there is no volume before the instant, or none after it, near enough
    current,  // it is made of the present partials by the present rules
    to_make,  // it is missing, damaged, or the present partials give another one
};

class MappedPartials;

class MosaicMaker {
  public:
    // Without a store, or without domains, it does nothing.
    MosaicMaker(cache::StoreWriter* store, std::vector<Domain> domains,
                FramesWhen frames = FramesWhen::volume_comes);

    // Does nothing for volumes that no domain uses. `threads` threads work on it. An error may be
    // temporary, for example when the system refuses a write; all other domains have ingested the
    // volume all the same.
    Result<Kept> take_in(const VolumeSource& source, int threads);
    [[nodiscard]] bool is_idle() const { return store_ == nullptr || domains_.empty(); }
    [[nodiscard]] const std::vector<Domain>& domains() const { return domains_; }
    // The domain of this name (not that of a partial) if it has frames or partials of the moment.
    [[nodiscard]] const Domain* find(std::string_view name, level2::Moment moment) const;

    // Makes a frame from the existing partials, and replaces the existing frame. `problems` names
    // partials that are left out. Errors: not_found if the domain is not configured, or no site has
    // a volume near the instant; bad_argument for an instant at which the domain has no frames.
    Result<FrameMade> make_again(const cache::GridName& frame, int threads,
                                 std::vector<std::string>& problems);
    // The state of the frame that make_again() would make. Errors as there.
    [[nodiscard]] Result<FrameStanding> standing_of(const cache::GridName& frame) const;
    // Missing frames, newest first: those between the partials of the newest volumes (at most
    // `newest` before the last) that are newer than the oldest frame in the cache. Errors: the
    // cache cannot be read.
    [[nodiscard]] Result<std::vector<cache::GridName>> missing_frames(
        std::chrono::milliseconds newest) const;

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
    // The caller must hold the mutex of the domain's frames.
    Result<FrameMade> make(const FrameJob& job, MappedPartials& partials,
                           std::vector<std::string>& problems);
    Status add_missing(const Domain& domain, level2::Moment moment,
                       std::chrono::milliseconds newest, std::vector<cache::GridName>& all) const;
    Status keep(const Domain& domain, level2::Moment moment, const VolumeSource& source,
                int threads, Kept& kept);
    Status refresh(const Domain& domain, level2::Moment moment,
                   const cache::GridDescription& changed, int threads, Kept& kept);

    cache::StoreWriter* store_;
    std::vector<Domain> domains_;
    FramesWhen frames_when_;
    GeometryCache geometries_;
    InstantCache instants_;
    std::mutex mutex_;  // guards frames_
    std::map<std::pair<std::string, level2::Moment>, std::mutex>
        frames_;  // one thread at a time for each
};

}  // namespace stormcellar::pipeline
