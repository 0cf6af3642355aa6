// bench/mosaic_run.h -- raw files of many sites to merged frames in a cache, as the daemon does it.
//
// Each file is read, decompressed, decoded (REF alone, in memory) and gridded on its site's window
// (pipeline::make_partial, by the default method of such cells: area); then a frame is made for
// each multiple of 5 minutes (pipeline::make_frame: both neighbors in time of each site, moved to
// the instant, merged) and committed to a cache. Nothing else is written.
// Unlike the daemon, which makes a frame again as each volume changes it, a frame is made once, as
// soon as all volumes are there that it is made of.
// Work goes through the five hours in half hours: libbz2 alone over their files, then all of the
// above; each has its own clock, so both see the same machine. Volumes are shared out between
// threads, each decoded and gridded by one; a frame's sites are, too.
// Memory   partials of at most an hour; each thread one volume.
#pragma once

#include <filesystem>

#include "bench/mosaic_feed.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

struct MosaicRun {
    double total_s = 0;    // raw files to frames in the cache
    double volumes_s = 0;  // of that, reading to partials; the rest are frames
    double cpu_s = 0;      // CPU time of total_s, by all threads
    double libbz2_s = 0;   // reading and libbz2 alone, as many threads
    double libbz2_cpu_s = 0;
    int volumes = 0;
    int frames = 0;
    FeedSize size;
};

// `cache` must be empty or not there; it has the frames afterward.
[[nodiscard]] Result<MosaicRun> run_mosaic(int sites, int threads,
                                           const std::filesystem::path& feed,
                                           const std::filesystem::path& cache,
                                           std::chrono::hours hours = feed_length);

}  // namespace stormcellar::bench
