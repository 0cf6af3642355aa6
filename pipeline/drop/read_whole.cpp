#include "pipeline/drop/read_whole.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <span>
#include <system_error>
#include <vector>

#include <unistd.h>

#include "base/beneath.h"
#include "base/checksum.h"
#include "base/steady_time.h"
#include "stormcellar/base/descriptor.h"
#include "stormcellar/level2/growing_volume.h"

namespace stormcellar::pipeline {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t read_stretch_bytes = std::size_t{256} << 10;

// Reads as many bytes as there are, up to the size of the buffer.
Result<std::size_t> read_stretch(int descriptor, const std::filesystem::path& path,
                                 std::span<std::byte> buffer) {
    std::size_t done = 0;
    while (done < buffer.size()) {
        const ssize_t got = ::read(descriptor, buffer.data() + done, buffer.size() - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            return fail(ErrorCode::io, "{}: {}", path.native(),
                        std::system_category().message(errno));
        }
        if (got == 0) break;
        done += static_cast<std::size_t>(got);
    }
    return done;
}

WholeFile read_by_stretches(const std::filesystem::path& beneath, const std::filesystem::path& path,
                            std::uint64_t size_bytes, const level2::DecodeOptions& options) {
    WholeFile file;
    const auto opened = open_beneath(beneath, path);
    if (!opened) {
        file.was_read = pass_on(opened);
        return file;
    }
    const Descriptor descriptor{*opened};
    Xxh3Stream hash;
    level2::GrowingVolume volume(options);
    std::vector<std::byte> buffer(read_stretch_bytes);
    Status taken;
    for (std::uint64_t done = 0; done < size_bytes;) {
        const auto start = Clock::now();
        const auto got = read_stretch(descriptor.number(), path, buffer);
        file.read_s += seconds_since(start);
        if (!got) {
            file.was_read = pass_on(got);
            return file;
        }
        // The file is shorter than it was. The caller will see that it has changed.
        if (*got == 0) break;
        done += *got;
        const auto stretch = std::span{buffer}.first(*got);
        hash.append(stretch);
        const auto decode_start = Clock::now();
        if (taken) taken = volume.append(stretch);
        file.decode_s += seconds_since(decode_start);
    }
    file.content_hash = hash.value();
    const auto start = Clock::now();
    file.decoded = volume.finish();
    file.decode_s += seconds_since(start);
    return file;
}

}  // namespace

WholeFile read_whole(const std::filesystem::path& beneath, const std::filesystem::path& path,
                     std::uint64_t size_bytes, const level2::DecodeOptions& options) {
    if (size_bytes > large_file_bytes) return read_by_stretches(beneath, path, size_bytes, options);
    WholeFile file;
    const auto read_start = Clock::now();
    const auto bytes = read_beneath(beneath, path, large_file_bytes);
    file.read_s = seconds_since(read_start);
    if (!bytes) {
        file.was_read = pass_on(bytes);
        return file;
    }
    file.content_hash = xxh3_64(*bytes);
    const auto decode_start = Clock::now();
    file.decoded = level2::decode(*bytes, options);
    file.decode_s = seconds_since(decode_start);
    return file;
}

}  // namespace stormcellar::pipeline
