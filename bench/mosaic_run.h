// bench/mosaic_run.h -- turns raw files of many sites into merged frames in a cache, as the daemon
// does.
//
// Each file is read, decompressed, decoded (REF alone, in memory) and gridded on its site's window
// (pipeline::make_partial, by the default method for such cells: area). Then pipeline::make_frame()
// makes a frame for each multiple of 5 minutes. For each site, it takes the volumes just before and
// just after this instant, moves their echo to the instant, and merges the sites. The frame is
// committed to a cache. Nothing else is written. The daemon makes a frame again when a volume
// changes it; this benchmark makes each frame once, as soon as all of its volumes exist.
//
// The run goes through the data in portions of half an hour. For each portion, libbz2 alone first
// decompresses the files, and then the work above is done. The two parts have separate clocks, so
// both run under the same conditions. Volumes are spread over the threads; one thread decodes and
// grids a volume. The sites of a frame are spread over the threads as well.
//
// Memory    Holds the partials of at most an hour, and one volume for each thread.
#pragma once

#include <filesystem>

#include "bench/mosaic_feed.h"
#include "stormcellar/base/result.h"

namespace stormcellar::bench {

struct MosaicRun {
    double total_s = 0;    // raw files to frames in the cache
    double volumes_s = 0;  // part of total_s from reading to partials; the rest makes frames
    double cpu_s = 0;      // CPU time of all threads during total_s
    double libbz2_s = 0;   // reading, and libbz2 alone, with the same number of threads
    double libbz2_cpu_s = 0;
    int volumes = 0;
    int frames = 0;
    FeedSize size;
};

enum class Beside { libbz2, nothing };  // work timed in addition

// Runs the experiment. `cache` must be empty or missing; it receives the frames.
[[nodiscard]] Result<MosaicRun> run_mosaic(int sites, int threads,
                                           const std::filesystem::path& feed,
                                           const std::filesystem::path& cache,
                                           std::chrono::hours hours = feed_length,
                                           FeedFiles files = FeedFiles::first_hour,
                                           Beside beside = Beside::libbz2);

}  // namespace stormcellar::bench
