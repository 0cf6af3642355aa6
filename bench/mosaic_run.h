// bench/mosaic_run.h -- turns raw files of many sites into merged frames in a cache, as the daemon
// does.
//
// Each file is read, decompressed, decoded (REF alone, in memory) and gridded on its site's window
// (pipeline::make_partial, by the default method for such cells: area). Then a frame is made for
// each multiple of 5 minutes (pipeline::make_frame: both neighbors in time of each site, moved to
// the instant, merged) and committed to a cache. Nothing else is written. The daemon makes a frame
// again when a volume changes it; here a frame is made once, as soon as all of its volumes are
// there.
//
// The work proceeds in half hours: libbz2 alone over their files, then all of the above. Each has
// its own clock, so both run under the same conditions. Volumes are shared out between threads,
// each decoded and gridded by one thread; so are the sites of a frame.
//
// Memory    Partials of at most an hour; one volume for each thread.
#pragma once

#include <filesystem>

#include "bench/mosaic_feed.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

struct MosaicRun {
    double total_s = 0;    // raw files to frames in the cache
    double volumes_s = 0;  // the part of it from reading to partials; the rest is for frames
    double cpu_s = 0;      // CPU time of total_s, of all threads
    double libbz2_s = 0;   // reading and libbz2 alone, with as many threads
    double libbz2_cpu_s = 0;
    int volumes = 0;
    int frames = 0;
    FeedSize size;
};

// `cache` must be empty or missing; it has the frames afterward.
[[nodiscard]] Result<MosaicRun> run_mosaic(int sites, int threads,
                                           const std::filesystem::path& feed,
                                           const std::filesystem::path& cache,
                                           std::chrono::hours hours = feed_length,
                                           FeedFiles files = FeedFiles::first_hour);

}  // namespace stormcellar::bench
