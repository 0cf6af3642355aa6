// stormcellar/fetch/fetch.h -- raw files from a public bucket, into a directory.
//
// Files keep their names and the times that the bucket has of them. One that is there with its size
// is not fetched again; one that was cut goes on where it ended. A file appears under its name when
// it is whole. What fails is tried again, ever later; what fails for good is in the report.
// The transfers are done by a module with libcurl, stormcellar_fetch.so, which nothing else loads.
// Thread contract: one thread.
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
    UtcTime from, to;  // of the volumes' starts, inclusive
    std::filesystem::path directory;
    int parallel = 8;                           // transfers at a time
    int tries = 6;                              // of each
    std::chrono::milliseconds first_wait{500};  // before the second try; twice as long each time
    std::chrono::seconds stall{30};             // a transfer without a byte for so long has failed
    std::function<void(const FetchProgress&)> progress;
    const std::atomic<bool>* stop = nullptr;  // when it is set no transfer goes on
};

struct FetchFailure {
    std::string what;  // a key, or what was to be listed
    std::string reason;
};

struct FetchReport {
    std::size_t found = 0;            // volumes of the stations and times
    std::size_t fetched = 0;          // of these now
    std::size_t present = 0;          // were there
    std::size_t without_radials = 0;  // _MDM: left out
    std::uint64_t bytes = 0;          // that came now
    std::vector<FetchFailure> failures;
    bool stopped = false;
};

// Errors: bad_argument for a source that is no address; unsupported where the module is not
// installed; those of the directory.
[[nodiscard]] Result<FetchReport> fetch(const FetchRequest& request);

// What the module gives, under this name.
using FetchEntry = void (*)(const FetchRequest& request, Result<FetchReport>& report);
inline constexpr const char* fetch_module_file = "stormcellar_fetch.so";
inline constexpr const char* fetch_module_entry = "stormcellar_fetch_files";

}  // namespace stormcellar::fetch
