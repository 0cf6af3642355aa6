#include "daemon/watch/file_stamp.h"

#include "base/beneath.h"

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
    return look_at(path, {});
}

FileFound look_at(const std::filesystem::path& path, const std::filesystem::path& beneath) {
    const auto facts = look_beneath(beneath, path);
    if (!facts) {
        const ErrorCode code = facts.error().code;
        const bool is_sure = code == ErrorCode::not_found || code == ErrorCode::permission;
        return {is_sure ? Standing::missing : Standing::unknown, {}, 0};
    }
    const mode_t mode = facts->st_mode;
    const Standing standing = S_ISREG(mode)   ? Standing::regular
                              : S_ISDIR(mode) ? Standing::directory
                                              : Standing::other;
    return {standing, stamp_of(*facts), mode};
}

}  // namespace stormcellar::daemon
