// stormcellar/fetch/fetch.h -- downloads raw files from a public bucket into a directory.
//
// Files keep the names and the times that they have in the bucket. A file that exists with its full
// size is not downloaded again; an interrupted transfer continues where it stopped. A file appears
// under its name only when it is complete. Failed transfers are tried again, with longer waits each
// time; the report lists the files that failed in the end.
//
// The module stormcellar_fetch.so, which links libcurl, makes the transfers; only fetch() loads it.
//
// Units     Sizes are in bytes.
// Threads   One thread at a time; fetch() calls `progress` on the thread that called it.
// Errors    See fetch(). If a single file fails, that is not an error; the report lists the file.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"

namespace stormcellar::fetch {

inline constexpr const char* default_source = "https://unidata-nexrad-level2.s3.amazonaws.com";

struct FetchProgress {
    std::size_t done = 0, files = 0;
    std::uint64_t bytes = 0;
};

struct FetchRequest {
    std::string source = default_source;
    std::vector<std::string> stations;
    UtcTime from, to;  // volumes that start in this range, both ends included
    std::filesystem::path directory;
    int parallel = 8;  // transfers at the same time
    int tries = 6;     // for each file
    // wait before the second try; doubled for each further try
    std::chrono::milliseconds first_wait{500};
    std::chrono::seconds stall{30};  // a transfer without a byte for this long has failed
    std::function<void(const FetchProgress&)> progress;
    const std::atomic<bool>* stop = nullptr;  // once it is set, fetch() stops all transfers
};

struct FetchFailure {
    std::string what;  // a key of the bucket, or the listing that failed
    std::string reason;
    // The server refuses this object or no longer has it; another try would fail, too.
    bool is_refused = false;
};

struct FetchReport {
    std::size_t found = 0;            // volumes of the requested stations and times
    std::size_t fetched = 0;          // downloaded by this call
    std::size_t present = 0;          // already in the directory
    std::size_t without_radials = 0;  // _MDM files, which are left out
    std::uint64_t bytes = 0;          // downloaded by this call
    std::vector<FetchFailure> failures;
    bool stopped = false;
};

// Downloads the files and returns a report. Errors: bad_argument if the source is not a URL;
// unsupported if the module is not installed; errors of the directory.
[[nodiscard]] Result<FetchReport> fetch(const FetchRequest& request);

// The type of the function that the module exports as fetch_module_entry.
using FetchEntry = void (*)(const FetchRequest& request, Result<FetchReport>& report);
inline constexpr const char* fetch_module_file = "stormcellar_fetch.so";
inline constexpr const char* fetch_module_entry = "stormcellar_fetch_files";

}  // namespace stormcellar::fetch
