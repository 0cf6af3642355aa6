#include "daemon/file_stamp.h"

namespace stormcellar::daemon {

namespace {

std::int64_t nanoseconds(const timespec& time) {
    return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

FileStamp stamp_of(const struct stat& facts) {
    return {static_cast<std::uint64_t>(facts.st_ino), static_cast<std::uint64_t>(facts.st_size),
            nanoseconds(facts.st_mtim), nanoseconds(facts.st_ctim)};
}

FileFound look_at(const std::filesystem::path& path) {
    struct stat facts {};
    if (::lstat(path.c_str(), &facts) != 0) return {};
    if (S_ISREG(facts.st_mode)) return {Standing::regular, stamp_of(facts), facts.st_mode};
    return {S_ISDIR(facts.st_mode) ? Standing::directory : Standing::other, stamp_of(facts),
            facts.st_mode};
}

}  // namespace stormcellar::daemon
