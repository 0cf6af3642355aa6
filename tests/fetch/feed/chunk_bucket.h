// tests/fetch/feed/chunk_bucket.h -- the public chunk bucket on loopback. The bucket answers like
// Amazon S3, with the faults that a test sets.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/utc_time.h"
#include "tests/fetch/scripted_server.h"

namespace stormcellar::feed {

class ChunkBucket {
  public:
    ChunkBucket() = default;
    ChunkBucket(const ChunkBucket&) = delete;
    ChunkBucket& operator=(const ChunkBucket&) = delete;

    [[nodiscard]] std::string url() const { return server_.url(); }
    void put(const std::string& key, std::string contents);
    // Puts chunks 1 to `chunks` of a volume. Chunk 1 is of kind S; the last chunk is of kind E if
    // `has_end`. The contents of a chunk are its key.
    void put_volume(const std::string& station, int number, UtcTime time, int chunks,
                    bool has_end = true);
    void remove(const std::string& key);
    // Makes listings give this size for the object, whatever its contents are.
    void say_size(const std::string& key, std::uint64_t bytes);
    void set_page(int keys) { page_ = keys; }
    // Returns the requests so far: "LIST KTLX/494/", "GET KTLX/494/20220317-000842-001-S".
    [[nodiscard]] std::vector<std::string> asked() const;
    [[nodiscard]] std::size_t count(std::string_view request) const;
    [[nodiscard]] std::map<std::string, std::string> objects() const;

    // Changes answers; the text is the request as in asked(). Set it before the first request.
    std::function<testing::Reply(const std::string&, testing::Reply)> change =
        [](const std::string&, testing::Reply reply) { return reply; };

  private:
    struct Object {
        std::string contents;
        std::uint64_t said_bytes = 0;
        UtcTime modified;
    };
    testing::Reply answer(const testing::Asked& asked);
    [[nodiscard]] std::string listing(const testing::Asked& asked) const;

    int page_ = 1000;
    mutable std::mutex mutex_;  // guards the members below
    std::map<std::string, Object> objects_;
    std::vector<std::string> asked_;
    testing::ScriptedServer server_{[this](const testing::Asked& asked) { return answer(asked); }};
};

// Returns the time as in keys: "20220317-000842".
[[nodiscard]] std::string dashed_time(UtcTime time);
[[nodiscard]] std::string key_of(const std::string& station, int volume, UtcTime time, int number,
                                 char kind);
// Returns the contents of the files below a directory, by their relative paths, with temporary
// files.
[[nodiscard]] std::map<std::string, std::string> files_below(
    const std::filesystem::path& directory);

}  // namespace stormcellar::feed
