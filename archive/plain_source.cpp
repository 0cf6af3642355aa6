#include "archive/plain_source.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <utility>

#include <archive.h>

namespace stormcellar::archive {
namespace {

constexpr std::size_t plain_block_bytes = std::size_t{16} << 10;

}  // namespace

PlainSource::PlainSource(ReadAt read_at, std::uint64_t size, ReadBudget& header)
    : read_at_(std::move(read_at)), size_(size), header_(header), block_(plain_block_bytes) {}

bool PlainSource::feed(::archive* handle) {
    archive_read_set_read_callback(
        handle, [](::archive* reader, void* of, const void** bytes) -> la_ssize_t {
            return static_cast<PlainSource*>(of)->read_more(reader, bytes);
        });
    archive_read_set_skip_callback(handle,
                                   [](::archive*, void* of, la_int64_t bytes) -> la_int64_t {
                                       return static_cast<PlainSource*>(of)->skip(bytes);
                                   });
    archive_read_set_seek_callback(
        handle, [](::archive*, void* of, la_int64_t offset, int whence) -> la_int64_t {
            return static_cast<PlainSource*>(of)->seek(offset, whence);
        });
    archive_read_set_callback_data(handle, this);
    return archive_read_open1(handle) == ARCHIVE_OK;
}

std::int64_t PlainSource::read_more(::archive* handle, const void** bytes) {
    const std::int64_t got = read_at_(at_, block_);
    if (got < 0) {
        has_failed_ = true;
        archive_set_error(handle, EIO, "it cannot be read");
        return ARCHIVE_FATAL;
    }
    if (!header_.take(handle, static_cast<std::uint64_t>(got))) return ARCHIVE_FATAL;
    at_ += static_cast<std::uint64_t>(got);
    *bytes = block_.data();
    return got;
}

std::int64_t PlainSource::skip(std::int64_t bytes) {
    const std::uint64_t left = size_ - std::min(size_, at_);
    const std::uint64_t skipped =
        std::min(left, static_cast<std::uint64_t>(std::max<std::int64_t>(0, bytes)));
    at_ += skipped;
    return static_cast<std::int64_t>(skipped);
}

std::int64_t PlainSource::seek(std::int64_t offset, int whence) {
    std::int64_t from = 0;
    if (whence == SEEK_CUR) from = static_cast<std::int64_t>(at_);
    if (whence == SEEK_END) from = static_cast<std::int64_t>(size_);
    std::int64_t to = 0;
    if (__builtin_add_overflow(from, offset, &to) || to < 0) return ARCHIVE_FATAL;
    at_ = static_cast<std::uint64_t>(to);
    return to;
}

}  // namespace stormcellar::archive
