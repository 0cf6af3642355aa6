#include "daemon/care/state_keeper.h"

#include <system_error>

#include "stormcellar/base/file_system.h"

namespace stormcellar::daemon {
namespace {

bool is_gone(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::symlink_status(path, error).type() ==
           std::filesystem::file_type::not_found;
}

}  // namespace

Status StateKeeper::hold() {
    std::error_code error;
    const std::filesystem::path catalog = state_ / "catalog";
    std::filesystem::create_directories(catalog, error);
    if (error) {
        const bool refused =
            error == std::errc::permission_denied || error == std::errc::read_only_file_system;
        return fail(refused ? ErrorCode::permission : ErrorCode::io, "{}: {}", catalog.native(),
                    error.message());
    }
    if (lock_ && !is_gone(state_ / pipeline::InstanceLock::file_name)) return {};
    auto lock = pipeline::InstanceLock::acquire(state_);
    if (!lock) return pass_on(lock);
    if (!lock_) {
        // Ignore a failure to remove temporary files of a killed service, because nothing depends
        // on them.
        for (const std::filesystem::path& directory : {state_, catalog})
            (void)remove_temporaries(real_file_system(), directory);
    }
    lock_.emplace(std::move(*lock));
    return {};
}

std::optional<Status> StateKeeper::look() {
    if (!is_gone(state_ / "catalog") && !is_gone(state_ / pipeline::InstanceLock::file_name))
        return std::nullopt;
    return hold();
}

}  // namespace stormcellar::daemon
